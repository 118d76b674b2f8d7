// SPDX-License-Identifier: Apache-2.0
// The report of a chart from pictures that several programs rendered: compare.py writes the
// manifest.
//
//   peers_chart MANIFEST.json FOLDER
#include <fmt/format.h>

#include "apps/chart/chart_report.h"
#include "io/base/json_parse.h"
#include "io/base/read_file.h"
#include "io/image/difference.h"
#include "io/image/flip.h"
#include "tests/measure/program.h"

namespace petzval {
namespace {

using nlohmann::json;

json read_manifest(const std::string& path) {
    const FileBytes file = read_file(path);
    if (!file.error.empty()) throw InputError(path, "", file.error);
    return json::parse(file.bytes);
}

Picture rgb_of(const json& file, const ChartFrame& frame) {
    return read_reference(std::string(file), frame.size, frame.crop);
}

MeasuredMethod measured(const json& method, const ChartReference& reference,
                        const ChartFrame& frame) {
    MeasuredMethod out;
    out.name = method["name"];
    const Flip flip(reference.picture, frame.exposure_ev);
    for (const json& point : method["points"]) {
        ChartPoint at{point["samples"], {}};
        for (const json& seed : point["seeds"]) {
            Picture picture = rgb_of(seed["file"], frame);
            at.seeds.push_back({seed["seed"], seed["cpu_s"],
                                compare(picture, reference.picture).front().relative_mse,
                                flip.mean(picture)});
            out.picture = std::move(picture);
        }
        out.points.push_back(std::move(at));
    }
    out.shown = out.points.size() - 1;
    out.flip_map = flip.map(out.picture);
    return out;
}

int run(int argc, char** argv) {
    if (argc != 3) {
        fmt::print(stderr, "usage: peers_chart MANIFEST.json FOLDER\n");
        return 2;
    }
    const json manifest = read_manifest(argv[1]);
    ChartReport report;
    report.subject.folder = argv[2];
    report.subject.request.scene = std::string(manifest["scene"]);
    report.threads = manifest["threads"];
    report.frame.size = {manifest["width"], manifest["height"]};
    report.frame.crop = {0, 0, report.frame.size.x, report.frame.size.y};
    report.frame.seeds = manifest["seeds"];
    std::filesystem::create_directories(report.subject.folder / "pictures");

    MeasuredCase of;
    of.of.axis = ChartAxis::Peers;
    of.of.name = manifest["name"];
    of.of.title = manifest["title"];
    of.of.reference.name = "each program's own";
    of.of.remarks = manifest["remarks"].get<std::vector<std::string>>();
    for (const json& method : manifest["methods"]) {
        std::vector<Picture> parts;
        for (const json& part : method["reference"]) parts.push_back(rgb_of(part, report.frame));
        const ChartReference reference = reference_of(parts, report.frame.exposure_ev);
        of.methods.push_back(measured(method, reference, report.frame));
        // The floor is the higher of the two.
        const bool first = !of.reference.relative_mse;
        const auto worse = [&](std::optional<double> a, std::optional<double> b) {
            return first ? a : std::optional(std::max(*a, *b));
        };
        const auto mse = worse(reference.relative_mse, of.reference.relative_mse);
        const auto flip = worse(reference.flip, of.reference.flip);
        if (first) of.reference = reference;
        of.reference.relative_mse = mse;
        of.reference.flip = flip;
    }
    write_case(report, of);
    for (const EfficiencyRow& row : efficiencies(of)) {
        const Interval e = row.point.efficiency();
        fmt::print(
            "{:<10} {:>5} samples {:>8.3g} CPU s  relative MSE {:<9.3g} efficiency {:.3g}/s "
            "({:.3g} to {:.3g}), {:.3g} of the first{}\n",
            row.method, row.point.samples, row.point.cpu_s().mean, row.point.relative_mse().mean,
            e.mean, e.low, e.high, row.to_first, row.believed ? "" : " (not believed)");
    }
    report.cases.push_back(std::move(of));
    write_report(report);
    return 0;
}

}  // namespace
}  // namespace petzval

int main(int argc, char** argv) {
    return petzval::guarded(petzval::run, argc, argv);
}
