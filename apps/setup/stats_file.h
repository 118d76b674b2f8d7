// SPDX-License-Identifier: Apache-2.0
// Cost of a render, as JSON.
#pragma once

#include <filesystem>

#include "apps/setup/render_setup.h"
#include "core/film/film.h"
#include "integrator/render_job.h"

namespace petzval {

struct RenderCost {
    double render_wall_s = 0, render_cpu_s = 0;
    int threads = 0;
};

/// Peak resident memory of this process, MiB.
[[nodiscard]] double peak_memory_mib();

/// Writes the statistics of a render as JSON. Throws InputError where the file cannot be written.
void write_stats(const std::filesystem::path&, const RenderSetup&, const RenderResult&,
                 const RenderCost&, const Film&);

}  // namespace petzval
