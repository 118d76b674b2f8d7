// SPDX-License-Identifier: Apache-2.0
#include "apps/live/lens_bench.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

#include "camera/bench/analysis.h"
#include "camera/bench/ray_path.h"
#include "camera/bench/spectral_lines.h"
#include "camera/bench/spot.h"
#include "camera/lens/focus.h"
#include "camera/lens/profile.h"
#include "camera/setup/lens_bench.h"
#include "io/base/error.h"
#include "io/lens/lens_file.h"

namespace petzval::apps {
namespace {

using Json = nlohmann::json;

constexpr double kMicrons = 1000;
constexpr int kRays = 7, kSpotSide = 24, kFanRays = 33, kMtfSteps = 40;
constexpr double kMostCycles_per_mm = 80;

/// A lens in focus, and the point that is looked at.
struct Bench : camera::LensBench {
    double field_deg = 0;

    [[nodiscard]] io::ArgumentError dark() const {
        return {lens->prescription().name, "", "lets no light through to that point of the film"};
    }
    [[nodiscard]] camera::AimedBundle bundle(double nm) const {
        auto found = aim(field_deg, nm);
        if (!found) throw dark();
        return *std::move(found);
    }
};

Bench set_up(const BenchRequest& request) {
    camera::Prescription file = io::parse_lens(request.lens, "the lens").lens;
    if (request.fstop > 0)
        if (auto stopped = camera::stopped_down(camera::Lens(file), request.fstop))
            file = *std::move(stopped);
    const double distance_mm =
        request.focus_m > 0 ? 1000 * request.focus_m : std::numeric_limits<double>::infinity();
    auto sharp = camera::LensBench::focused(camera::Lens(file), distance_mm);
    if (!sharp) throw io::ArgumentError(file.name, "", "forms no image at that distance");
    Bench out{*std::move(sharp)};
    if (!(request.height_mm > 0)) return out;
    const auto field_deg = camera::field_of_height_deg(*out.lens, request.height_mm, out.film_mm);
    // In a plane at a distance nothing lies aside of the lens, or behind.
    if (!field_deg || (std::isfinite(out.distance_mm) && !(*field_deg < 90))) throw out.dark();
    out.field_deg = *field_deg;
    return out;
}

void add_figure(Json& out, const char* name, std::string text) {
    out["figures"].push_back({name, std::move(text)});
}

void add_section(const Bench& bench, Json& out) {
    const camera::Lens& lens = *bench.lens;
    out["faces"] = out["elements"] = Json::array();
    for (int i = 0; i < lens.size(); ++i) {
        out["faces"].push_back(camera::surface_outline(lens, i, camera::Section::Y));
        out["elements"].push_back(camera::element_outline(lens, i, camera::Section::Y));
    }
    out["stop"] = {{"surface", lens.stop()},
                   {"z", lens.vertex_mm(lens.stop())},
                   {"radius", lens.prescription().surfaces[size_t(lens.stop())].semi_diameter_mm}};
    out["film"] = {{"z", bench.film_mm}, {"radius", lens.prescription().image_circle_mm / 2}};
}

void add_rays(const Bench& bench, Json& out) {
    std::vector<camera::BundleRay> all, of_line;
    const camera::AimedBundle main = bench.bundle(kLineD_nm);
    const camera::PupilPoint chief = main.chief();
    const auto centre = main.trace({&chief, 1}, bench.film_mm, camera::Clip::No);
    if (centre.empty()) throw bench.dark();
    for (const char* name : {"rays", "spots"}) out[name] = Json::array();
    out["fans"] = {{"tangential", Json::array()}, {"sagittal", Json::array()}};
    for (const camera::SpectralLine& line : camera::kSpectralLines) {
        const camera::AimedBundle bundle = bench.bundle(line.nm);
        for (const camera::PupilPoint& point : camera::section_points(bundle, kRays))
            out["rays"].push_back(
                {{"colour", line.colour},
                 {"path", camera::ray_path(*bench.lens, bundle, point, bench.film_mm,
                                           0.25 * bench.film_mm)}});
        of_line = bundle.trace(bundle.grid(kSpotSide), bench.film_mm);
        all.insert(all.end(), of_line.begin(), of_line.end());
        Json points = Json::array();
        for (const camera::BundleRay& ray : of_line) points.push_back(ray.film_mm);
        out["spots"].push_back({{"colour", line.colour}, {"film_mm", std::move(points)}});
        for (const auto& [name, along] :
             {std::pair{"tangential", camera::Section::Y}, {"sagittal", camera::Section::X}}) {
            Json fan = Json::array();
            for (const camera::FanPoint& point : camera::ray_fan(
                     *bench.lens, bundle, along, bench.film_mm, centre[0].film_mm, kFanRays))
                fan.push_back(
                    {point.stop, kMicrons * point.from_mm[along == camera::Section::X ? 0 : 1]});
            out["fans"][name].push_back({{"colour", line.colour}, {"um", std::move(fan)}});
        }
    }
    if (all.empty()) throw bench.dark();
    const camera::SpotSize size = camera::spot_size(all);
    out["middle_mm"] = size.centroid_mm;
    Json tangential = Json::array(), sagittal = Json::array();
    for (int i = 0; i <= kMtfSteps; ++i) {
        const double cycles = kMostCycles_per_mm * i / kMtfSteps;
        tangential.push_back({cycles, camera::geometric_mtf(all, cycles, camera::Section::Y)});
        sagittal.push_back({cycles, camera::geometric_mtf(all, cycles, camera::Section::X)});
    }
    out["mtf"] = {{"tangential", std::move(tangential)}, {"sagittal", std::move(sagittal)}};
    add_figure(out, "spot, RMS radius", fmt::format("{:.1f} µm", kMicrons * size.rms_mm));
    add_figure(out, "best focus",
               fmt::format("{:+.3f} mm behind the film", camera::best_shift_mm(all)));
}

void add_figures(const Bench& bench, double height_mm, Json& out) {
    const camera::Lens& lens = *bench.lens;
    const camera::FirstOrder paraxial = camera::first_order(lens, kLineD_nm);
    add_figure(out, "focal length", fmt::format("{:.2f} mm", paraxial.focal_length_mm));
    add_figure(out, "f-number",
               fmt::format("{:.3g}", camera::fnumber_of(lens, out["stop"]["radius"])));
    add_figure(out, "field",
               fmt::format("{:.2f}°, {:.2f} mm from the middle", bench.field_deg, height_mm));
    if (bench.field_deg > 0 && bench.field_deg < 89)
        if (const auto found =
                camera::distortion(lens, bench.field_deg, bench.film_mm, bench.distance_mm))
            add_figure(out, "distortion", fmt::format("{:+.2f} %", 100 * found->relative()));
    const auto light = camera::film_irradiance(bench.lens, bench.film_mm, {0, height_mm});
    if (light[0] > 0)
        add_figure(out, "light", fmt::format("{:.0f} % of the middle", 100 * light[1] / light[0]));
}

}  // namespace

Json bench_facts(const BenchRequest& request) {
    const Bench bench = set_up(request);
    Json out{{"figures", Json::array()}};
    add_section(bench, out);
    add_figures(bench, request.height_mm, out);
    add_rays(bench, out);
    return out;
}

}  // namespace petzval::apps
