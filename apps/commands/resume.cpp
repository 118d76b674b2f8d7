// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/resume.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "apps/cli/quantity.h"
#include "apps/cli/reading_options.h"
#include "apps/cli/sequence_options.h"
#include "apps/commands/render.h"
#include "apps/state/run_record.h"
#include "io/base/error.h"

namespace petzval {
namespace {

namespace fs = std::filesystem;

struct ResumeOptions {
    fs::path state;
    std::string progress;
    int threads = 0;  ///< 0: as the render was asked to
    bool quiet = false;
};

// Words of the render in a state, with what is asked for anew.
std::vector<std::string> words_of(const RunRecord& record, const ResumeOptions& o) {
    std::vector<std::string> words = record.command, added;
    if (o.threads > 0) added.insert(added.end(), {"--threads", fmt::format("{}", o.threads)});
    if (!o.progress.empty()) {
        std::erase(words, "--quiet");
        added.insert(added.end(), {"--progress", o.progress});
    }
    if (o.quiet) added.emplace_back("--quiet");
    return with_words(words, added);
}

int resume(const ResumeOptions& o, Session& session) {
    const StateReader reader(o.state);
    reader.check();  // before anything that it says is done
    const RunRecord record = record_in(reader.header(), o.state);
    const auto refuse = [&](const std::string& why) {
        return InputError(o.state.string(), "", why);
    };
    if (record.command.empty() || record.command.front() != "render")
        throw refuse("holds no command of a render");
    ParsedRender parsed;
    try {
        parsed = parse_render(words_of(record, o));
    } catch (const CLI::ParseError& error) {
        throw refuse(fmt::format("holds a command that is not understood: {}", error.what()));
    }
    const auto& outputs = parsed.options->outputs;
    if (reader.header().is_complete()) {
        if (std::all_of(outputs.begin(), outputs.end(), is_state_name)) {
            session.console.notice(o.state.string() + " is complete: there is nothing to render");
            return kSuccess;
        }
        parsed.options->keep.skip_existing = true;  // its pictures may be there
    }
    const fs::path state = fs::absolute(o.state);
    // What the command names relative to its folder means what it meant.
    std::error_code error;
    fs::current_path(record.folder, error);
    if (error)
        throw refuse(fmt::format(
            "its render ran in the folder {}, which cannot be entered: {}; make that folder, with "
            "the files of the render",
            record.folder.string(), error.message()));
    session.words = record.command;
    parsed.options->keep.resumed_from = state;
    return run_render(*parsed.options, session);
}

}  // namespace

std::vector<std::string> words_of_console(const std::vector<std::string>& words) {
    if (words.size() < 2 || words.front() != "resume") return words;
    std::vector<std::string> all;
    for (size_t i = 1; i < words.size() && all.empty(); ++i) try {
            const StateReader reader(words[i]);
            all = record_in(reader.header(), words[i]).command;
        } catch (const InputError&) {  // an option, or what resume() will refuse
        }
    if (all.empty()) return words;
    if (std::find(words.begin(), words.end(), "--progress") != words.end())
        std::erase(all, "--quiet");
    return with_words(all, {words.begin() + 1, words.end()});
}

void add_resume_command(CLI::App& app, Session& session) {
    auto options = std::make_shared<ResumeOptions>();
    CLI::App* command =
        app.add_subcommand("resume", "go on with a render that was stopped, from its state");
    command->add_option("state", options->state, "NAME.state of the render")->required();
    command->add_option("--threads", options->threads, "another number of threads")
        ->transform(whole_number_between(1, kMostThreads));
    command->add_option("--progress", options->progress, "as of petzval render");
    command->add_flag("--quiet", options->quiet, "print nothing but errors");
    command->callback([options, &session] { session.exit_code = resume(*options, session); });
}

}  // namespace petzval
