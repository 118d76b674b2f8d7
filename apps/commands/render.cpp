// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/render.h"

#include <CLI/CLI.hpp>

#include "apps/cli/command_line.h"
#include "apps/commands/render_one.h"
#include "apps/commands/render_sequence.h"

namespace petzval {

ParsedRender parse_render(const std::vector<std::string>& words) {
    ParsedRender out{std::make_unique<CLI::App>(), std::make_unique<RenderOptions>()};
    out.app->option_defaults()->take_last();  // of an option that is given twice
    CLI::App* command = out.app->add_subcommand("render");
    add_render_options(*command, *out.options);
    out.app->name("petzval");
    try {
        // CLI11 takes the words from the end of a vector.
        out.app->parse(std::vector<std::string>(words.rbegin(), words.rend()));
    } catch (const CLI::ExtrasError& error) {
        throw CLI::ParseError(explanation(*out.app, error, {}), CLI::ExitCodes::ExtrasError);
    }
    return out;
}

int run_render(RenderOptions& o, Session& session) {
    const Notice notice = [&](const std::string& text) { session.console.notice(text); };
    if (o.keep.log) session.console.log_to(*o.keep.log);
    if (is_sequence(o)) return render_sequence(o, notice, session);
    SequencePlace alone;
    return render_one(o, session.words, notice, session, alone);
}

void add_render_command(CLI::App& app, Session& session) {
    auto options = std::make_shared<RenderOptions>();
    CLI::App* command = app.add_subcommand("render", "render a glTF scene to EXR, PNG or JPEG");
    add_render_options(*command, *options);
    command->callback([options, &session] { session.exit_code = run_render(*options, session); });
}

}  // namespace petzval
