// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/reading_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "apps/cli/parse.h"
#include "apps/cli/quantity.h"
#include "io/base/machine.h"

namespace petzval {
namespace {

constexpr double kThinnest_m = 1e-9, kThickest_m = 1e9;

}  // namespace

std::optional<uint64_t> ReadingOptions::memory_bytes() const {
    if (max_memory.empty()) return std::nullopt;
    return parse_memory_bytes("--max-memory", max_memory);
}

GltfChoices ReadingOptions::all_choices() const {
    GltfChoices all = choices;
    all.animation = time.animation();
    return all;
}

PictureBudget ReadingOptions::pictures() const {
    const auto bytes = memory_bytes();
    return bytes ? PictureBudget(*bytes) : PictureBudget();
}

void add_memory_option(CLI::App& app, ReadingOptions& o) {
    app.add_option("--max-memory", o.max_memory,
                   "memory for decoded pictures, as 512MB or 8GB (default: half of what the "
                   "machine or its control group has)");
}

void add_reading_options(CLI::App& app, ReadingOptions& o) {
    add_memory_option(app, o);
    app.add_flag("--confine", o.confine,
                 "refuse files that the scene names outside its own folder");
    app.add_option("--variant", o.choices.variant,
                   "variant of the file's materials, by name or index (petzval info lists them)");
    app.add_option("--scene", o.choices.scene,
                   "scene of the file, by name or number (default: the one that it names)");
    app.add_option("--point-line-radius", o.choices.point_line_radius_m,
                   "draw the file's points as spheres and its lines as cylinders of this radius: "
                   "2mm, 0.01 (default: they are skipped)")
        ->transform(number_between(kThinnest_m, kThickest_m, kMetres));
    add_time_options(app, o.time);
}

int usual_threads() {
    return std::min(usable_threads(), kMostThreads);
}

}  // namespace petzval
