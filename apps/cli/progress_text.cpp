// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/progress_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "io/base/format.h"

namespace petzval::apps {
namespace {

constexpr double kYear_s = 365.25 * 86400;
/// Largest fraction of a render that is not done.
constexpr double kNearlyDone = 0.999;

std::string duration_text(double seconds) {
    if (!(seconds < kYear_s)) return "more than a year";
    const long s = std::lround(std::max(seconds, 0.0));
    if (s < 3600) return fmt::format("{}:{:02}", s / 60, s % 60);
    if (s < 100 * 3600) return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
    return fmt::format("{} days", (s + 43200) / 86400);
}

std::string rate_text(double per_s) {
    if (per_s < 1e4) return fmt::format("{:.0f} samples/s", per_s);
    if (per_s < 1e6) return fmt::format("{:.0f} k samples/s", per_s / 1e3);
    return fmt::format("{:.3g} M samples/s", per_s / 1e6);
}

/// Percentage with one digit, rounded down: 100 is for the end.
std::string percent_text(double fraction) {
    return fmt::format("{:.1f} %", std::floor(1000 * fraction) / 10);
}

std::string bar(double fraction, size_t width) {
    const auto full = static_cast<size_t>(fraction * static_cast<double>(width));
    return fmt::format("[{:#<{}}{:.<{}}]", "", full, "", width - full);
}

std::string cut(const std::string& text, int columns) {
    return text.substr(0, static_cast<size_t>(std::max(columns, 0)));
}

// What was there before: as much of the whole as its samples are, or as the time that it took.
double share_at_start(const ProgressGoal& goal) {
    if (goal.total) return static_cast<double>(goal.before) / static_cast<double>(*goal.total);
    return goal.time_limit_s ? std::min(goal.spent_s / *goal.time_limit_s, 1.) : 0.;
}

}  // namespace

ProgressFigures figures_under_way(const ProgressGoal& goal, uint64_t pixel_samples,
                                  double elapsed_s) {
    const bool any = pixel_samples > goal.before;
    const auto done = any ? static_cast<double>(pixel_samples - goal.before) : 0.;
    ProgressFigures out{pixel_samples, elapsed_s, done / std::max(elapsed_s, 1e-9), 0, {}};
    const auto left_to = [&](uint64_t samples) {
        return samples > pixel_samples
                   ? static_cast<double>(samples - pixel_samples) / out.samples_per_s
                   : 0.;
    };
    if (any && goal.total) out.left_s = left_to(*goal.total);
    if (goal.time_limit_s) {
        const double to_limit_s = std::max(*goal.time_limit_s - goal.spent_s - elapsed_s, 0.);
        if (any)
            out.left_s = std::max(std::min(out.left_s.value_or(to_limit_s), to_limit_s),
                                  left_to(goal.first_pass));
        else if (to_limit_s > 0)
            out.left_s = to_limit_s;
    }
    const double at_start = share_at_start(goal);
    out.fraction = std::min(at_start, kNearlyDone);
    if (out.left_s && elapsed_s + *out.left_s > 0)
        out.fraction = std::clamp(at_start + (1 - at_start) * elapsed_s / (elapsed_s + *out.left_s),
                                  0., kNearlyDone);
    return out;
}

ProgressFigures figures_at_end(uint64_t pixel_samples, double elapsed_s) {
    return {pixel_samples, elapsed_s,
            static_cast<double>(pixel_samples) / std::max(elapsed_s, 1e-9), 1, 0.};
}

std::string progress_line(const ProgressFigures& f, int columns, ProgressBar with_bar) {
    constexpr size_t kShortestBar = 10, kLongestBar = 30, kAroundBar = 3;
    enum Part { Percent, Noise, Rate, Elapsed, Left, Count };
    std::array<std::string, Count> texts;
    texts[Percent] = percent_text(f.fraction);
    if (f.noise > 0) texts[Noise] = "noise " + io::percent(f.noise);
    texts[Rate] = rate_text(f.samples_per_s);
    texts[Elapsed] = duration_text(f.elapsed_s);
    if (f.fraction < 1) {
        texts[Elapsed] += " gone";
        texts[Left] = f.left_s ? duration_text(*f.left_s) + " left" : "";
    }
    const auto room = static_cast<size_t>(std::max(columns, 0));
    std::array<bool, Count> shown{true};
    size_t used = texts[Percent].size();
    const auto add = [&](Part part) {
        const size_t wanted = texts[part].size() + 2;
        if (texts[part].empty() || used + wanted > room) return;
        shown[part] = true;
        used += wanted;
    };
    add(f.fraction < 1 ? Left : Elapsed);
    add(Noise);
    const bool barred = with_bar == ProgressBar::Yes && used + kShortestBar + kAroundBar <= room;
    if (barred) used += kShortestBar + kAroundBar;
    add(Rate);
    if (f.fraction < 1) add(Elapsed);
    std::string line;
    if (barred) line = bar(f.fraction, std::min(kLongestBar, kShortestBar + room - used)) + " ";
    for (const Part part : {Percent, Noise, Rate, Elapsed, Left})
        if (shown[part]) line += (part == Percent ? "" : "  ") + texts[part];
    return cut(line, columns);
}

std::string phase_line(Phase phase, double elapsed_s, int columns) {
    constexpr std::array<const char*, static_cast<size_t>(Phase::Count)> kTexts{
        "loading", "building the BVH", "choosing settings", "rendering", "denoising", "writing"};
    return cut(fmt::format("{}  {}", kTexts[static_cast<size_t>(phase)], duration_text(elapsed_s)),
               columns);
}

}  // namespace petzval::apps
