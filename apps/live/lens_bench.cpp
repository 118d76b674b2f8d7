// SPDX-License-Identifier: Apache-2.0
#include "apps/live/lens_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "camera/bench/analysis.h"
#include "camera/bench/ray_path.h"
#include "camera/bench/spot.h"
#include "camera/lens/focus.h"
#include "camera/lens/profile.h"
#include "camera/setup/focused_lens.h"
#include "io/base/error.h"
#include "io/file/assets.h"
#include "io/file/read_file.h"
#include "io/lens/lens_file.h"

namespace petzval {
namespace {

using Json = nlohmann::json;

constexpr std::array<double, 3> kLines_nm{kLineF_nm, kLineD_nm, kLineC_nm};
constexpr double kMicrons = 1000;
constexpr int kRays = 7, kSpotSide = 24, kFanRays = 33, kMtfSteps = 40;
constexpr double kMostCycles_per_mm = 80;

/// A lens in focus, and the point that is looked at.
struct Bench {
    std::string name;
    std::shared_ptr<const Lens> lens;
    double film_mm = 0, distance_mm = 0, field_deg = 0;

    [[nodiscard]] AimedBundle bundle(double nm) const {
        auto found = AimedBundle::aim(*lens, {field_deg, distance_mm, Section::Y}, nm);
        if (!found)
            throw ArgumentError(name, "", "lets no light through to that point of the film");
        return *std::move(found);
    }
};

Prescription prescription_of(const BenchRequest& request) {
    if (request.edited.empty()) return load_lens(request.lens).lens;
    return parse_lens(request.edited, request.lens).lens;
}

Bench set_up(const BenchRequest& request) {
    Bench out{request.lens, nullptr, 0, std::numeric_limits<double>::infinity(), 0};
    if (request.focus_m > 0) out.distance_mm = 1000 * request.focus_m;
    Prescription prescription = prescription_of(request);
    if (request.fstop > 0) {
        const Lens open(prescription);
        double& radius_mm = prescription.surfaces[size_t(open.stop())].semi_diameter_mm;
        if (const auto wanted_mm = stop_radius_for(open, request.fstop))
            radius_mm = std::min(radius_mm, *wanted_mm);
    }
    auto sharp =
        focused_from_pupil(Lens(std::move(prescription)), out.distance_mm, FocusBy::Paraxial);
    if (!sharp) throw ArgumentError(request.lens, "", "forms no image at that distance");
    out.lens = std::make_shared<const Lens>(std::move(sharp->lens));
    out.film_mm = out.lens->film_mm();
    if (request.height_mm > 0) {
        const auto field_deg = field_of_height_deg(*out.lens, request.height_mm, out.film_mm);
        if (!field_deg)
            throw ArgumentError(request.lens, "",
                                "lets no light through to {:.3g} mm from the middle of the film",
                                request.height_mm);
        out.field_deg = *field_deg;
    }
    return out;
}

void add_section(const Bench& bench, Json& out) {
    const Lens& lens = *bench.lens;
    out["faces"] = out["elements"] = Json::array();
    for (int i = 0; i < lens.size(); ++i) {
        out["faces"].push_back(surface_outline(lens, i, Section::Y));
        out["elements"].push_back(element_outline(lens, i, Section::Y));
    }
    out["stop"] = {{"surface", lens.stop()},
                   {"z", lens.vertex_mm(lens.stop())},
                   {"radius", lens.prescription().surfaces[size_t(lens.stop())].semi_diameter_mm}};
    out["film"] = {{"z", bench.film_mm}, {"radius", lens.prescription().image_circle_mm / 2}};
}

void add_rays(const Bench& bench, Json& out) {
    std::vector<BundleRay> all, of_line;
    const AimedBundle main = bench.bundle(kLineD_nm);
    const PupilPoint chief = main.chief();
    const auto centre = main.trace({&chief, 1}, bench.film_mm, Clip::No);
    if (centre.empty())
        throw ArgumentError(bench.name, "", "lets no light through to that point of the film");
    for (const char* name : {"rays", "spots"}) out[name] = Json::array();
    out["fans"] = {{"tangential", Json::array()}, {"sagittal", Json::array()}};
    for (const double nm : kLines_nm) {
        const AimedBundle bundle = bench.bundle(nm);
        for (const PupilPoint& point : section_points(bundle, kRays))
            out["rays"].push_back({{"nm", nm},
                                   {"path", ray_path(*bench.lens, bundle, point, bench.film_mm,
                                                     0.25 * bench.film_mm)}});
        of_line = bundle.trace(bundle.grid(kSpotSide), bench.film_mm);
        all.insert(all.end(), of_line.begin(), of_line.end());
        Json points = Json::array();
        for (const BundleRay& ray : of_line) points.push_back(ray.film_mm);
        out["spots"].push_back({{"nm", nm}, {"film_mm", std::move(points)}});
        for (const auto& [name, along] :
             {std::pair{"tangential", Section::Y}, {"sagittal", Section::X}}) {
            Json fan = Json::array();
            for (const FanPoint& point :
                 ray_fan(*bench.lens, bundle, along, bench.film_mm, centre[0].film_mm, kFanRays))
                fan.push_back({point.stop, kMicrons * point.from_mm[along == Section::X ? 0 : 1]});
            out["fans"][name].push_back({{"nm", nm}, {"um", std::move(fan)}});
        }
    }
    if (all.empty())
        throw ArgumentError(bench.name, "", "lets no light through to that point of the film");
    const SpotSize size = spot_size(all);
    out["middle_mm"] = size.centroid_mm;
    Json tangential = Json::array(), sagittal = Json::array();
    for (int i = 0; i <= kMtfSteps; ++i) {
        const double cycles = kMostCycles_per_mm * i / kMtfSteps;
        tangential.push_back({cycles, geometric_mtf(all, cycles, Section::Y)});
        sagittal.push_back({cycles, geometric_mtf(all, cycles, Section::X)});
    }
    out["mtf"] = {{"tangential", std::move(tangential)}, {"sagittal", std::move(sagittal)}};
    const auto shown = [&](const char* name, std::string text) {
        out["figures"].push_back({name, std::move(text)});
    };
    shown("spot, RMS radius", fmt::format("{:.1f} µm", kMicrons * size.rms_mm));
    shown("best focus", fmt::format("{:+.3f} mm behind the film", best_shift_mm(all)));
}

void add_figures(const Bench& bench, double height_mm, Json& out) {
    const Lens& lens = *bench.lens;
    const auto shown = [&](const char* name, std::string text) {
        out["figures"].push_back({name, std::move(text)});
    };
    const FirstOrder paraxial = first_order(lens, kLineD_nm);
    shown("focal length", fmt::format("{:.2f} mm", paraxial.focal_length_mm));
    shown("f-number", fmt::format("{:.3g}", fnumber_of(lens, out["stop"]["radius"])));
    shown("field", fmt::format("{:.2f}°, {:.2f} mm from the middle", bench.field_deg, height_mm));
    if (bench.field_deg > 0 && bench.field_deg < 89)
        if (const auto found = distortion(lens, bench.field_deg, bench.film_mm, bench.distance_mm))
            shown("distortion", fmt::format("{:+.2f} %", 100 * found->relative()));
    const auto light = film_irradiance(bench.lens, bench.film_mm, {0, height_mm});
    if (light[0] > 0)
        shown("light", fmt::format("{:.0f} % of the middle", 100 * light[1] / light[0]));
}

}  // namespace

std::string lens_text(const std::string& name) {
    const auto known = list_lenses();
    const auto is = [&](const LensSummary& lens) { return lens.name == name; };
    if (std::ranges::none_of(known, is))
        throw ArgumentError(name, "", "no lens of that name ships");
    const FileBytes file = read_file(asset("lenses/" + name + ".json"));
    if (!file.error.empty()) throw InputError(name, "", file.error);
    return {file.bytes.begin(), file.bytes.end()};
}

Json bench_facts(const BenchRequest& request) {
    const Bench bench = set_up(request);
    Json out{{"figures", Json::array()}};
    add_section(bench, out);
    add_figures(bench, request.height_mm, out);
    add_rays(bench, out);
    return out;
}

}  // namespace petzval
