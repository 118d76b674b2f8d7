// SPDX-License-Identifier: Apache-2.0
#include "apps/chart/chart_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "io/build/build.h"
#include "io/file/atomic_file.h"
#include "io/file/rescue.h"
#include "io/image/flip.h"
#include "io/image/output.h"
#include "io/image/picture_files.h"
#include "io/plot/plot.h"

namespace petzval::apps {
namespace {

using Json = nlohmann::ordered_json;
using Measure = Interval (ChartPoint::*)() const;

/// Name as part of a file's name: letters, digits, points and dashes.
std::string file_word(const std::string& name) {
    std::string out;
    for (const char c : name) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '.';
        if (plain) out += c;
        if (!plain && !out.empty() && out.back() != '-') out += '-';
    }
    return out;
}

/// Heat map of errors. Black, blue, red, yellow, white: darker to lighter, so that it reads in grey
/// on paper too.
io::Picture heat(const std::vector<float>& errors, const io::Picture& like) {
    constexpr std::array<std::array<float, 3>, 5> kStops{
        {{0, 0, 0}, {0.2f, 0.05f, 0.5f}, {0.8f, 0.2f, 0.3f}, {1, 0.7f, 0.2f}, {1, 1, 1}}};
    io::Picture out = like;
    for (size_t i = 0; i < errors.size(); ++i) {
        const float at = std::clamp(errors[i], 0.f, 1.f) * (kStops.size() - 1);
        const size_t below = std::min(static_cast<size_t>(at), kStops.size() - 2);
        const float t = at - static_cast<float>(below);
        for (size_t c = 0; c < 3; ++c)
            out.pixels[3 * i + c] = (1 - t) * kStops[below][c] + t * kStops[below + 1][c];
    }
    return out;
}

/// Pareto front: points of all methods that are believed and that no other beats.
io::PlotSeries front_of(const MeasuredCase& of, Measure error) {
    std::vector<std::array<double, 2>> points;
    for (const MeasuredMethod& method : of.methods)
        for (const ChartPoint& point : method.points)
            if (of.believed(point)) points.push_back({point.cpu_s().mean, (point.*error)().mean});
    io::PlotSeries front{{}, io::PlotStyle::Dashes, "Pareto front"};
    front.grey = true;
    for (const size_t i : pareto_front(points)) front.points.push_back(points[i]);
    return front;
}

io::Plot plot_of(const MeasuredCase& of, Measure error, const std::string& y_label,
                 std::optional<double> floor) {
    io::Plot plot{
        .title = of.of.title, .x_label = "CPU time (s)", .y_label = y_label, .series = {}};
    plot.logarithmic = true;
    io::PlotSeries doubted{
        {}, io::PlotStyle::Points, "not believed: too near the reference's error"};
    doubted.grey = true;
    double first_s = INFINITY, last_s = 0;
    for (const MeasuredMethod& method : of.methods) {
        io::PlotSeries series{{}, io::PlotStyle::LinesAndPoints, method.name};
        for (const ChartPoint& point : method.points) {
            const double cpu_s = point.cpu_s().mean;
            const Interval e = (point.*error)();
            series.points.push_back({cpu_s, e.mean});
            series.y_bounds.push_back({e.low, e.high});
            if (!of.believed(point)) doubted.points.push_back({cpu_s, e.mean});
            first_s = std::min(first_s, cpu_s);
            last_s = std::max(last_s, cpu_s);
        }
        plot.series.push_back(std::move(series));
    }
    if (io::PlotSeries front = front_of(of, error); !front.points.empty())
        plot.series.push_back(std::move(front));
    if (floor && *floor > 0)
        plot.series.push_back({{{first_s, *floor}, {last_s, *floor}},
                               io::PlotStyle::Lines,
                               "error of the reference",
                               {},
                               true});
    if (!doubted.points.empty()) plot.series.push_back(std::move(doubted));
    return plot;
}

void write_plots(const std::filesystem::path& folder, const std::string& name,
                 const io::Plot& plot) {
    for (const char* ending : {".svg", ".png"}) io::write_plot(folder / (name + ending), plot);
}

Json json_of(const Interval& v) {
    const auto number = [](double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); };
    return {{"mean", number(v.mean)}, {"low_95", number(v.low)}, {"high_95", number(v.high)}};
}

Json json_of(const MeasuredCase& of, const ChartPoint& point) {
    Json seeds = Json::array();
    for (const ChartSeed& s : point.seeds)
        seeds.push_back({{"seed", s.seed},
                         {"cpu_s", s.cpu_s},
                         {"symmetric_mse", s.symmetric_mse},
                         {"relative_mse", s.relative_mse},
                         {"flip", s.flip}});
    return {{"samples", point.samples},
            {"cpu_s", json_of(point.cpu_s())},
            {"symmetric_mse", json_of(point.symmetric_mse())},
            {"relative_mse", json_of(point.relative_mse())},
            {"flip", json_of(point.flip())},
            {"efficiency_per_s", json_of(point.efficiency())},
            {"believed", of.believed(point)},
            {"seeds", std::move(seeds)}};
}

Json json_of(const MeasuredCase& of, const ChartFrame& frame) {
    const auto or_null = [](std::optional<double> v) { return v ? Json(*v) : Json(nullptr); };
    Json methods = Json::array();
    for (const MeasuredMethod& method : of.methods) {
        Json points = Json::array();
        for (const ChartPoint& point : method.points) points.push_back(json_of(of, point));
        methods.push_back({{"name", method.name}, {"points", std::move(points)}});
    }
    const ChartReference& r = of.reference;
    Json reference;
    if (!of.methods.empty())
        reference = {{"by", frame.reference ? frame.reference_name : of.of.reference.name},
                     {"parts", r.parts},
                     {"samples_of_a_part", r.samples},
                     {"cpu_s", r.cpu_s},
                     {"symmetric_mse", or_null(r.symmetric_mse)},
                     {"relative_mse", or_null(r.relative_mse)},
                     {"flip_at_most", or_null(r.flip)}};
    return {{"axis", name_of(of.of.axis)}, {"name", of.of.name},
            {"remarks", of.of.remarks},    {"reference", std::move(reference)},
            {"wall_s", of.wall_s},         {"methods", std::move(methods)}};
}

std::string csv_of(const ChartReport& report) {
    std::string text =
        "axis,case,method,samples,seed,cpu_s,symmetric_mse,relative_mse,flip,believed\n";
    for (const MeasuredCase& of : report.cases)
        for (const MeasuredMethod& method : of.methods)
            for (const ChartPoint& point : method.points)
                for (const ChartSeed& s : point.seeds)
                    text += fmt::format("{},{},{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{}\n",
                                        name_of(of.of.axis), of.of.name, method.name, point.samples,
                                        s.seed, s.cpu_s, s.symmetric_mse, s.relative_mse, s.flip,
                                        of.believed(point) ? 1 : 0);
    return text;
}

std::string settings_of(const ChartReport& report) {
    const SceneRequest& scene = report.subject.request;
    const ChartFrame& frame = report.frame;
    std::string text =
        fmt::format("{} at {}x{}", scene.scene.filename().string(), frame.size.x, frame.size.y);
    if (frame.crop.width() != frame.size.x || frame.crop.height() != frame.size.y)
        text += fmt::format(", pixels {},{} to {},{}", frame.crop.x0, frame.crop.y0, frame.crop.x1,
                            frame.crop.y1);
    if (scene.camera.lens) text += ", lens " + *scene.camera.lens;
    if (scene.camera.fstop) text += fmt::format(", f/{:g}", *scene.camera.fstop);
    text += fmt::format(", {} seeds, {} threads, budget {:g} s", frame.seeds, report.threads,
                        report.budget_s);
    return text;
}

}  // namespace

std::vector<EfficiencyRow> efficiencies(const MeasuredCase& of) {
    std::vector<EfficiencyRow> rows;
    for (const MeasuredMethod& method : of.methods) {
        const auto last = std::find_if(method.points.rbegin(), method.points.rend(),
                                       [&](const ChartPoint& p) { return of.believed(p); });
        EfficiencyRow row{method.name, method.points.back(), last != method.points.rend()};
        if (row.believed) row.point = *last;
        const double first =
            rows.empty() ? row.point.efficiency().mean : rows.front().point.efficiency().mean;
        row.to_first = row.point.efficiency().mean / first;
        rows.push_back(std::move(row));
    }
    return rows;
}

std::vector<std::string> head_of(const ChartReport& report, const MeasuredCase& of) {
    std::vector<std::string> head{settings_of(report) + "."};
    const ChartReference& r = of.reference;
    if (report.frame.reference) {
        head.push_back(
            fmt::format("Reference: {}; its own error is not known, so that there is no "
                        "floor and every point is taken as it is.",
                        report.frame.reference_name));
    } else if (r.symmetric_mse) {
        head.push_back(fmt::format(
            "Reference: {}; {} parts of {} samples, {:.3g} CPU s. Its own symmetric MSE is {:.2g}, "
            "its FLIP at most {:.2g}; a point of less than twice that symmetric MSE is not "
            "believed.",
            of.of.reference.name, r.parts, r.samples, r.cpu_s, *r.symmetric_mse, *r.flip));
    }
    for (const std::string& remark : of.of.remarks) head.push_back(remark + ".");
    return head;
}

PictureNames picture_names(const MeasuredCase& of, const MeasuredMethod& method) {
    const std::string stem = "pictures/" + of.of.name + "-" + file_word(method.name);
    return {stem + ".png", stem + "-flip.png"};
}
std::filesystem::path reference_picture_name(const MeasuredCase& of) {
    return "pictures/" + of.of.name + "-reference.png";
}

void write_case(const ChartReport& report, const MeasuredCase& of) {
    if (of.methods.empty()) return;
    const auto& folder = report.subject.folder;
    const io::DisplayOptions display{.exposure_ev = report.frame.exposure_ev};
    std::vector<std::function<void()>> writes{
        [&] {
            write_plots(folder, of.of.name,
                        plot_of(of, &ChartPoint::symmetric_mse, "symmetric MSE",
                                of.reference.symmetric_mse));
        },
        [&] {
            write_plots(
                folder, of.of.name + "-relative",
                plot_of(of, &ChartPoint::relative_mse, "relative MSE", of.reference.relative_mse));
        },
        [&] {
            write_plots(folder, of.of.name + "-flip",
                        plot_of(of, &ChartPoint::flip, "FLIP", of.reference.flip));
        },
        [&] {
            io::write_output(folder / reference_picture_name(of), of.reference.picture, display);
        }};
    for (const MeasuredMethod& method : of.methods)
        writes.emplace_back([&] {
            const PictureNames names = picture_names(of, method);
            io::write_output(folder / names.picture, method.picture, display);
            io::write_8bit(folder / names.error, heat(method.flip_map, method.picture));
        });
    io::attempt_all(writes);
}

void write_points(const ChartReport& report, const std::filesystem::path& csv) {
    io::write_file_atomically(csv, std::string_view(csv_of(report)));
}

void write_report(const ChartReport& report) {
    const auto& folder = report.subject.folder;
    Json cases = Json::array();
    for (const MeasuredCase& of : report.cases) cases.push_back(json_of(of, report.frame));
    const Json all{{"program", io::program_version()},
                   {"scene", report.subject.request.scene.filename().string()},
                   {"size_px", {report.frame.size.x, report.frame.size.y}},
                   {"threads", report.threads},
                   {"budget_s", report.budget_s},
                   {"cases", std::move(cases)}};
    // Names of files need not be UTF-8.
    const std::string json = all.dump(2, ' ', true, Json::error_handler_t::replace) + "\n";
    io::attempt_all(
        {[&] { write_points(report, folder / "points.csv"); },
         [&] { io::write_file_atomically(folder / "points.json", std::string_view(json)); },
         [&] {
             io::write_file_atomically(folder / "report.html",
                                       std::string_view(report_html(report)));
         }});
}

}  // namespace petzval::apps
