// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/render.h"

#include <CLI/CLI.hpp>
#include <memory>

#include "apps/cli/command_line.h"
#include "apps/cli/field_options.h"
#include "apps/commands/render_one.h"
#include "apps/commands/render_sequence.h"

namespace petzval::apps {

int run_render(const RenderOrder& order, Session& session,
               const std::optional<std::filesystem::path>& resumed_from) {
    const io::Notice notice = [&](const std::string& text) { session.console.notice(text); };
    check_sequence(order);
    if (order.run.log) session.console.log_to(*order.run.log);
    if (order.sequence.several()) return render_sequence(order, notice, session);
    SequencePlace alone;
    return render_one(order, resumed_from, notice, session, alone);
}

void add_render_command(CLI::App& app, Session& session) {
    auto order = std::make_shared<RenderOrder>();
    CLI::App* command = app.add_subcommand("render", "render a glTF scene to EXR, PNG or JPEG");
    add_field_options(*command, *order, kRender);
    CLI::Option* const output = command->get_option("--output")->required();
    command->get_option("--sheet")->each([output](const std::string&) {
        output->required(false);  // the sheet is one
    });
    command->callback([order, command, &session] {
        if (const auto& sweep = order->sequence.sweep; sweep && !find_field(sweep->field)) {
            if (sweep->field == "method")
                throw CLI::ValidationError(
                    "--sweep",
                    "leave out \"method=\": what it names is swept as filter-radius=1,2");
            throw no_such_option(*command, "--" + sweep->field);
        }
        session.exit_code = run_render(*order, session);
    });
}

}  // namespace petzval::apps
