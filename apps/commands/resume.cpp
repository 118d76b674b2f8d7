// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/resume.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "apps/cli/field_options.h"
#include "apps/commands/render.h"
#include "apps/request/file_names.h"
#include "apps/request/value_error.h"
#include "apps/state/run_record.h"
#include "io/base/error.h"
#include "io/base/format.h"

namespace petzval::apps {
namespace {

namespace fs = std::filesystem;

struct ResumeOptions {
    fs::path state;
    RenderOrder order;  ///< of what is asked for anew
    bool asks_progress = false;
};

// Order of the render in a state, with what is asked for anew.
RenderOrder order_in(const RunRecord& record, const ResumeOptions& o) {
    RenderOrder order = order_of(record.fields);
    const RunRequest& asked = o.order.run;
    if (asked.threads > 0) order.run.threads = asked.threads;
    if (o.asks_progress) {
        order.run.progress = asked.progress;
        order.run.quiet = false;
    }
    order.run.quiet = order.run.quiet || asked.quiet;
    return order;
}

int resume(const ResumeOptions& o, Session& session) {
    const io::StateReader reader(o.state);
    reader.check();  // before anything that it says is done
    const RunRecord record = record_in(reader.header(), o.state);
    const auto refuse = [&](const std::string& why) {
        return io::InputError(o.state.string(), "", why);
    };
    RenderOrder order;
    try {
        order = order_in(record, o);
        check_sequence(order);
        if (order.sequence.several()) throw ValueError("--frames", "a state is of one picture");
    } catch (const ValueError& error) {
        throw refuse(fmt::format("holds a request that is not understood: {}", error.what()));
    }
    const std::optional<double> noise = o.order.render.samples.noise;
    if (noise) {
        std::optional<double>& before = order.render.samples.noise;
        if (!before) throw refuse("was rendered without ⟨noise⟩, and cannot take one up");
        if (*noise > *before)
            throw refuse(fmt::format("asks for a noise of {}: a higher one is reached already",
                                     io::percent(*before)));
        before = noise;
    }
    if (reader.header().is_complete() && !noise) {
        if (std::ranges::all_of(order.run.outputs, is_state_name)) {
            session.console.notice(o.state.string() + " is complete: there is nothing to render");
            return kSuccess;
        }
        order.run.skip_existing = true;  // its pictures may be there
    }
    const fs::path state = fs::absolute(o.state);
    // What the request names relative to its folder means what it meant.
    std::error_code error;
    fs::current_path(record.folder, error);
    if (error)
        throw refuse(fmt::format(
            "its render ran in the folder {}, which cannot be entered: {}; make that folder, with "
            "the files of the render",
            record.folder.string(), error.message()));
    return run_render(order, session, state);
}

}  // namespace

ConsoleWish console_wish_of(const std::vector<std::string>& words) {
    ConsoleWish asked = console_wish(words);
    if (words.size() < 2 || words.front() != "resume") return asked;
    for (size_t i = 1; i < words.size(); ++i) try {
            const io::StateReader reader(words[i]);
            const RunRequest before = order_of(record_in(reader.header(), words[i]).fields).run;
            if (!asked.asks_progress && before.progress == ProgressStyle::Json)
                asked.style = ConsoleStyle::Json;
            asked.quiet = asked.quiet || (before.quiet && !asked.asks_progress);
            return asked;
        } catch (const io::InputError&) {  // an option, or what resume() will refuse
        }
    return asked;
}

void add_resume_command(CLI::App& app, Session& session) {
    auto options = std::make_shared<ResumeOptions>();
    CLI::App* command =
        app.add_subcommand("resume", "go on with a render that was stopped, from its state");
    command->add_option("state", options->state, "NAME.state of the render")->required();
    for (const char* field : {"noise", "threads", "progress", "quiet"})
        add_field_option(*command, options->order, field);
    command->callback([options, command, &session] {
        options->asks_progress = command->count("--progress") > 0;
        session.exit_code = resume(*options, session);
    });
}

}  // namespace petzval::apps
