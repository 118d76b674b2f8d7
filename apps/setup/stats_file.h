// SPDX-License-Identifier: Apache-2.0
// Cost of a render, as JSON.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/setup/denoised_film.h"
#include "core/film/film.h"
#include "integrator/path/stats.h"
#include "integrator/render/noise_target.h"
#include "io/file/rescue.h"

namespace petzval::apps {

/// Counts and times of a render that add up: over the runs of one that was resumed, and over the
/// parts of a merged one.
struct RunFigures {
    integrator::PathStats stats;
    double load_s = 0, bvh_s = 0, render_wall_s = 0, render_cpu_s = 0;
    int threads = 0, workers = 0;  ///< most of any run: asked for, and that rendered a tile
    double peak_memory_mib = 0;    ///< largest of any run

    RunFigures& operator+=(const RunFigures&);
};

/// Figures as JSON, and back. Throws a nlohmann::json exception where a member is missing.
[[nodiscard]] nlohmann::ordered_json to_json(const RunFigures&);
[[nodiscard]] RunFigures figures_from(const nlohmann::ordered_json&);

/// How a run went, beside what it rendered.
struct RunReport {
    const char* stopped_by = nullptr;  ///< name of the signal; nullptr where none stopped it
    std::vector<std::pair<const char*, double>> phase_s;  ///< wall time of each phase, by name
    std::vector<io::WriteOutcome> outputs;
    std::vector<std::string> notices, warnings, errors;
};

/// The picture that figures are of.
struct StatsPicture {
    int width = 0, height = 0;  ///< of the full frame
    SampleRange samples;        ///< that every pixel has
    float exposure_ev = 0;
    Film::LeftOut left_out;
    std::optional<integrator::NoiseReport> noise{};  ///< where one was to be reached
    std::shared_ptr<const DenoisedFilm> denoised{};  ///< where it was denoised
};

/// Peak resident memory of this process, MiB.
[[nodiscard]] double peak_memory_mib();

/// Writes the statistics of a render as JSON; docs/guide/render.md has the schema. Throws
/// OutputError where the file cannot be written.
void write_stats(const std::filesystem::path&, const StatsPicture&, const RunFigures&,
                 const RunReport&);

}  // namespace petzval::apps
