// SPDX-License-Identifier: Apache-2.0
// Measures methods against a reference: cost and error over growing numbers of samples.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/chart/chart_methods.h"
#include "apps/chart/chart_points.h"
#include "core/film/film.h"
#include "integrator/render/executor.h"
#include "io/base/clock.h"
#include "io/base/error.h"
#include "io/image/flip.h"
#include "io/picture/picture.h"

namespace petzval::apps {

inline constexpr uint32_t kChartSeeds = 5;  ///< at least: for an interval of confidence
inline constexpr uint32_t kMostChartSeeds = 1000;
inline constexpr double kLeastChartBudget_s = 4;     ///< for each case of weight 1
inline constexpr uint32_t kReferenceReplicates = 4;  ///< independent renders
inline constexpr uint32_t kFirstReferenceSeed = 1'000'000;

/// Clocks of a chart, in seconds; tests step their own.
struct ChartClock {
    std::function<double()> wall_s = integrator::steady_s;  ///< budgets are of this one
    std::function<double()> cpu_s = io::process_cpu_s;      ///< costs are of this one
};

/// The budget is too small for one sample of everything.
class TooSlow : public io::ArgumentError {
  public:
    using io::ArgumentError::ArgumentError;
};

/// Settings that all cases of a chart share.
struct ChartFrame {
    V2i size{192, 108};
    Rect crop;
    uint32_t seeds = kChartSeeds;
    float exposure_ev = 0;  ///< of pictures, and of what FLIP compares
    /// In place of references that are rendered; R, G and B of the crop.
    std::optional<io::Picture> reference;
    std::string reference_name;
};

struct ChartReference {
    io::Picture picture;
    uint32_t parts = 0, samples = 0;  ///< of each part; none for a file
    double cpu_s = 0;
    /// Of the picture itself: the two MSE from the variance of its parts, and FLIP between its two
    /// halves, which is twice as noisy in amplitude and so a bound. Unknown for a file.
    std::optional<double> symmetric_mse, relative_mse, flip;
};

struct MeasuredMethod {
    std::string name;
    std::vector<ChartPoint> points;
    size_t shown = 0;     ///< the point of the pictures
    io::Picture picture;  ///< of the first seed there
    std::vector<float> flip_map;
};

struct MeasuredCase {
    ChartCase of;
    ChartReference reference;
    std::vector<MeasuredMethod> methods;
    std::optional<double> equal_cpu_s;  ///< about what each method's picture took
    double wall_s = 0;

    /// Whether a measured symmetric MSE says something about the method: at least twice the
    /// reference's, as what is measured is the sum of both.
    [[nodiscard]] bool believed(const ChartPoint&) const;
};

/// Errors of a picture from the reference, which `flip` holds too; seed and cost are left at 0.
[[nodiscard]] ChartSeed errors_of(const io::Picture&, const io::Picture& reference,
                                  const io::Flip& flip);
/// A reference from independent renders, three or more, with its own error from their spread.
[[nodiscard]] ChartReference reference_of(const std::vector<io::Picture>& parts, float exposure_ev);
/// A reference from a file: R, G and B of the crop. Throws InputError where it has not this frame.
[[nodiscard]] io::Picture read_reference(const std::filesystem::path&, V2i size, Rect crop);

/// Renders the reference in about a third of the time, then all methods, turn by turn, at 1, 2, 4,
/// ... samples, as long as the next number fits: a method's renders with one seed are one render
/// that is measured on its way. Ends within the budget but for what one sample of each takes.
/// Nothing where the monitor said stop. Throws what SetUpView does, and TooSlow.
[[nodiscard]] std::optional<MeasuredCase> measure(const ChartCase&, const ChartFrame&,
                                                  double budget_s, integrator::TbbExecutor&,
                                                  integrator::RenderMonitor&, const SetUpView&,
                                                  const ChartClock&);

}  // namespace petzval::apps
