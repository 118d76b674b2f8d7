// SPDX-License-Identifier: Apache-2.0
// Figures of a render's progress, and the line that shows them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "apps/setup/phase.h"

namespace petzval::apps {

/// Ends of a render: whichever comes first.
struct ProgressGoal {
    uint64_t first_pass = 1;        ///< pixel samples that are taken whatever the time limit
    std::optional<uint64_t> total;  ///< pixel samples; absent where only time bounds it
    std::optional<double> time_limit_s;
    double spent_s = 0;                 ///< of the time limit, before it began
    uint64_t before = 0;                ///< pixel samples that were there when it began
    std::pair<int, int> part_of{0, 1};  ///< of a sequence: its number from 0, of so many
};

/// How far rendering is.
struct ProgressFigures {
    uint64_t pixel_samples = 0;
    double elapsed_s = 0, samples_per_s = 0;
    double fraction = 0;           ///< of the time that it will take; 1 only at the end
    std::optional<double> left_s;  ///< absent while nothing is known
    double noise = 0;              ///< of the picture so far; 0 where it is not known
};

/// Figures of a render under way. It cannot end before its first pass, nor later than its total.
[[nodiscard]] ProgressFigures figures_under_way(const ProgressGoal&, uint64_t pixel_samples,
                                                double elapsed_s);
/// Figures of a render that is done, by its samples or its time.
[[nodiscard]] ProgressFigures figures_at_end(uint64_t pixel_samples, double elapsed_s);

enum class ProgressBar : bool { No, Yes };

/// Progress of rendering in one line of at most so many columns: what fits, the most important
/// first.
[[nodiscard]] std::string progress_line(const ProgressFigures&, int columns, ProgressBar);
/// The same of another phase, of which only the time is known.
[[nodiscard]] std::string phase_line(Phase, double elapsed_s, int columns);

}  // namespace petzval::apps
