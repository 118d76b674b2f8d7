// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/time_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>

#include "apps/cli/quantity.h"
#include "io/base/csv.h"
#include "io/base/error.h"

namespace petzval {
namespace {

constexpr double kMost_s = 1e6, kMostFps = 1e6, kLeastFps = 1e-3;
constexpr std::array<Unit, 4> kSeconds{{{"s"}, {"sec"}, {"ms", 1, 1000}, {"min", 60, 1}}};
constexpr std::string_view kFrame = "frame:";

}  // namespace

double parse_time_s(const std::string& option, const std::string& text, double fps) {
    const std::string_view given = trimmed(text);
    std::optional<double> s;
    if (given.starts_with(kFrame)) {
        if (const auto frame = number<double>(given.substr(kFrame.size()))) s = *frame / fps;
    } else {
        s = quantity(given, kSeconds);
    }
    if (!s || !(std::fabs(*s) <= kMost_s))
        throw CLI::ValidationError(
            option, fmt::format("\"{}\" is not a time such as 1.25s, 40ms or frame:30", text));
    return *s;
}

std::optional<AnimationChoice> TimeOptions::animation() const {
    if (!at) {
        if (!animations.empty() || loop)
            throw CLI::ValidationError(animations.empty() ? "--loop" : "--animation",
                                       "needs a time: --at 1s");
        return std::nullopt;
    }
    return AnimationChoice{parse_time_s("--at", *at, fps), animations, loop};
}

ShutterCurve parse_shutter_curve(const std::string& option, const std::string& text) {
    if (text.empty() || text == "box") return ShutterCurve::box();
    if (text == "trapezoid") return ShutterCurve::trapezoid();
    if (text.find('.') == text.npos && text.find('/') == text.npos)
        throw CLI::ValidationError(
            option,
            fmt::format("\"{}\" is neither box, trapezoid nor the name of a CSV file", text));
    const CsvTable table = read_csv(text);
    if (table.names.size() != 2)
        throw InputError(text, table.place(0), "must hold two columns, time and open");
    if (table.rows.size() < 2)
        throw InputError(text, table.place(0), "must hold two rows at least");
    const double first = table.rows.front()[0], whole = table.rows.back()[0] - first;
    ShutterCurve curve;
    for (size_t i = 0; i < table.rows.size(); ++i) {
        const auto& row = table.rows[i];
        if (i > 0 && !(row[0] >= table.rows[i - 1][0]))
            throw InputError(text, table.place(i), "is at an earlier time than the row before it");
        if (!(row[1] >= 0 && row[1] <= 1e6))
            throw InputError(text, table.place(i), "is open by less than 0, or over 1e6");
        curve.points.push_back(
            {static_cast<float>((row[0] - first) / whole), static_cast<float>(row[1])});
    }
    if (!(whole > 0) || !(curve.efficiency() > 0))
        throw InputError(text, table.place(0), "never lets any light in");
    return curve;
}

void add_time_options(CLI::App& app, TimeOptions& o) {
    const auto group = [](CLI::Option* option) { return option->group("Time"); };
    group(app.add_option(
        "--at", o.at,
        "moment of the file's animations: 1.25s, 40ms, frame:30 (default: the pose that the file "
        "stores)"));
    group(app.add_option("--fps", o.fps, "frames in a second (default 24)"))
        ->transform(number_between(kLeastFps, kMostFps));
    group(app.add_option("--animation", o.animations,
                         "animation that is played, by name or number; may be given again "
                         "(default: all that do not contradict an earlier one)"))
        ->allow_extra_args(false);
    group(app.add_flag("--loop", o.loop,
                       "an animation begins anew at its end (default: it stays as it ends)"));
}

}  // namespace petzval
