// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/resume.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "apps/cli/quantity.h"
#include "apps/cli/reading_options.h"
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

int resume(const ResumeOptions& o, Session& session) {
    const StateHeader header = StateReader(o.state).header();
    const RunRecord record = record_in(header, o.state);
    if (header.is_complete()) {
        session.console.notice(o.state.string() + " is complete: there is nothing to render");
        return kSuccess;
    }
    const fs::path state = fs::absolute(o.state);
    // What the command names relative to its folder means what it meant.
    std::error_code error;
    fs::current_path(record.folder, error);
    if (error)
        throw InputError(o.state.string(), "",
                         fmt::format("its render ran in the folder {}, which cannot be entered: {}",
                                     record.folder.string(), error.message()));
    std::vector<std::string> words = record.command;
    if (o.threads > 0) words.insert(words.end(), {"--threads", fmt::format("{}", o.threads)});
    if (!o.progress.empty()) words.insert(words.end(), {"--progress", o.progress});
    if (o.quiet) words.emplace_back("--quiet");
    const ParsedRender parsed = parse_render(words);
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
    all.insert(all.end(), words.begin() + 1, words.end());
    return all;
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
