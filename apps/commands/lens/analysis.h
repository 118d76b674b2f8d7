// SPDX-License-Identifier: Apache-2.0
// What the subcommands of `petzval lens` that plot have in common.
#pragma once

#include <functional>

#include "apps/commands/lens/field.h"
#include "camera/bench/spot.h"
#include "io/plot/plot.h"

namespace petzval::apps {

/// Result of an analysis: a diagram, and the numbers in it.
struct Found {
    io::Plot plot;
    std::vector<std::string> names{};
    std::vector<std::vector<double>> rows{};
};

struct AnalysisOptions {
    FieldRequest field;
    std::string plot, csv, light;
    std::string map;  ///< file of a second plot, which the analysis writes
    double most_cycles = 100, image_circle_mm = 0;
    bool wave = false;
};
using Analysis = std::function<Found(const AnalysisOptions&)>;

inline constexpr double kMicrons = 1000;  // in a mm

/// Adds a subcommand with the options of a field request, -o and --csv, that writes what its
/// analysis finds.
std::shared_ptr<AnalysisOptions> add_analysis(CLI::App& lens, const char* name, const char* help,
                                              bool with_fields, const Analysis&,
                                              const char* footer);
/// A length as tables with six decimals show it: not -0.000000.
[[nodiscard]] double shown(double mm);
[[nodiscard]] std::string title_of(const camera::Lens&, const std::string& what);
/// set_up() for a lens that lets light through to the middle of the film.
[[nodiscard]] FieldSetup set_up_lit(const FieldRequest&, const std::vector<double>& shares);
/// The section that a setup's field is not in.
[[nodiscard]] camera::Section across(const FieldSetup&);
/// Rays of a bundle from side x side cells of its box.
[[nodiscard]] std::vector<camera::BundleRay> traced(const camera::AimedBundle&, double film_mm,
                                                    int side);
[[noreturn]] void refuse_dark(const camera::Lens&, double field_deg);

}  // namespace petzval::apps
