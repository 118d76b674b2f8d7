// SPDX-License-Identifier: Apache-2.0
// Cost of a render, as JSON.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "apps/setup/render_setup.h"
#include "core/film/film.h"
#include "integrator/render_job.h"
#include "io/base/rescue.h"

namespace petzval {

struct RenderCost {
    double render_wall_s = 0, render_cpu_s = 0;
    int threads = 0;
};

/// How a run went, beside what it rendered.
struct RunReport {
    const char* stopped_by = nullptr;  ///< name of the signal; nullptr where none stopped it
    std::vector<std::pair<const char*, double>> phase_s;  ///< wall time of each phase, by name
    std::vector<WriteOutcome> outputs;
    std::vector<std::string> notices, warnings, errors;
};

/// Peak resident memory of this process, MiB.
[[nodiscard]] double peak_memory_mib();

/// Writes the statistics of a render as JSON; docs/guide/render.md has the schema. Throws
/// OutputError where the file cannot be written.
void write_stats(const std::filesystem::path&, const RenderSetup&, const RenderResult&,
                 const RenderCost&, const RunReport&, const Film&);

}  // namespace petzval
