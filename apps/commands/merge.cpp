// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/merge.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "apps/commands/render_files.h"
#include "apps/plan/plan_wording.h"
#include "apps/request/file_names.h"
#include "apps/setup/input_files.h"
#include "apps/state/merge.h"
#include "io/base/error.h"

namespace petzval::apps {
namespace {

namespace fs = std::filesystem;

struct MergeOptions {
    std::vector<fs::path> states, outputs;
    std::optional<fs::path> stats;
    bool quiet = false;  ///< the console takes it from the words
};

void check_files(const MergeOptions& o) {
    std::vector<io::NamedFile> inputs, outputs;
    for (const fs::path& state : o.states) inputs.push_back({"a state to merge", state});
    for (const fs::path& output : o.outputs) outputs.push_back({"-o", output});
    if (o.stats) outputs.push_back({"--stats", *o.stats});
    io::refuse_overwriting(outputs, inputs);
    io::refuse_overwriting(outputs, own_files());
    for (const io::NamedFile& output : outputs) io::check_writable(output.path);
}

// Throws where the display's configuration is not what it was.
void check_display(const RunRecord& record) {
    const auto is_same = [&] { return record.facts.display == display_facts(record.display); };
    if (!record.display.config.empty() && !is_same())
        throw io::InputError(record.display.config.string(), "",
                             "has changed since the states were written; their pictures would look "
                             "different");
}

int merge(const MergeOptions& o, Session& session) {
    check_files(o);
    MergedState merged = merge_states(o.states);
    const Film& film = merged.film;
    // Of a render until an error was reached a state has the most samples that there might be.
    if (film.keeps().halves) merged.samples.end = merged.samples.first + film.taken_range().least;
    check_display(merged.record);
    std::vector<fs::path> pictures, states;
    for (const fs::path& output : o.outputs)
        (is_state_name(output) ? states : pictures).push_back(output);
    const auto notice = [&](const std::string& text) { session.console.notice(text); };
    const auto noise = reached_noise(merged.record.facts, film, merged.samples);
    if (noise) notice(text_of(*noise, merged.record.facts.noise->noise));
    std::shared_ptr<const DenoisedFilm> denoised;
    if (film.keeps().halves) {
        integrator::TbbExecutor executor(threads_of(RunRequest{}));
        session.interrupt.arm();
        denoised = denoised_film(film, executor, session.interrupt.monitor().stop);
        if (!denoised) return kStopped;
        notice(text_of(*denoised));
    }
    std::vector<io::WriteOutcome> outcomes = write_pictures(
        pictures, merged.record.display,
        {film, merged.samples, merged.record.facts, noise, denoised}, false, session.console);
    for (const fs::path& state : states)
        outcomes.push_back(io::write_or_rescue(state, [&](const fs::path& to) {
            io::StateHeader header =
                header_of(merged.record, io::FilmShape::of(film), merged.samples);
            header.is_finished = true;
            io::write_state(to, std::move(header), film);
        }));
    if (o.stats)
        outcomes.push_back(io::write_or_rescue(*o.stats, [&](const fs::path& to) {
            RunReport report;
            report.outputs = outcomes;
            write_stats(to,
                        {film.full_size().x, film.full_size().y, merged.samples,
                         merged.record.display.exposure_ev, film.left_out(), noise, denoised},
                        merged.record.figures, report);
        }));
    bool written = true;
    for (const io::WriteOutcome& one : outcomes) {
        written = written && one.written();
        const bool told = std::find(pictures.begin(), pictures.end(), one.wanted) != pictures.end();
        if (!one.written() && !told) session.console.error(one.message());
    }
    if (const auto told = left_out_text(film)) notice(*told);
    if (!written) return kOutputFailed;
    return noise && noise->left > 0 ? kNoiseLeft : kSuccess;
}

}  // namespace

void add_merge_command(CLI::App& app, Session& session) {
    auto options = std::make_shared<MergeOptions>();
    CLI::App* command =
        app.add_subcommand("merge", "add the states of parts of a render, and write its picture");
    command->add_option("states", options->states, "states of ranges of samples, or of crops")
        ->required();
    command->add_option("-o,--output", options->outputs, "picture or state to write")
        ->required()
        ->allow_extra_args(false)
        ->check(complaint_about_render_name);
    command->add_option("--stats", options->stats,
                        "write summed counts and times to this JSON file");
    command->add_flag("--quiet", options->quiet, "print nothing but errors");
    command->callback([options, &session] { session.exit_code = merge(*options, session); });
}

}  // namespace petzval::apps
