// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/lens/waves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/cli/console.h"
#include "io/base/error.h"

namespace petzval::apps {
namespace {

constexpr double kLeast_nm = 100, kMost_nm = 20000;

void warn_beyond_range(const camera::Lens& lens, double nm) {
    for (const Glass& glass : lens.media())
        if (nm < glass.first_nm || nm > glass.last_nm)
            print_notice(
                fmt::format("warning: {:g} nm is beyond {:g} to {:g} nm, for which the "
                            "formula of {} is made: its index is held there",
                            nm, glass.first_nm, glass.last_nm, glass.name));
}

// Middle of the image of all lines together, by rays.
std::array<double, 2> middle_of(const FieldSetup& setup, double field_deg,
                                const std::vector<camera::AimedBundle>& bundles,
                                const std::vector<LightLine>& light) {
    std::array<double, 2> middle{};
    for (size_t i = 0; i < light.size(); ++i) {
        const auto point = camera::image_point(bundles[i], setup.film_mm);
        if (!point) refuse_dark(*setup.lens, field_deg);
        for (size_t k = 0; k < 2; ++k) middle[k] += light[i].weight * (*point)[k];
    }
    return middle;
}

double radius_of_half_mm(std::vector<camera::BundleRay> rays,
                         const std::array<double, 2>& middle_mm) {
    std::vector<double> radii;
    for (const camera::BundleRay& ray : rays)
        radii.push_back(std::hypot(ray.film_mm[0] - middle_mm[0], ray.film_mm[1] - middle_mm[1]));
    const auto half = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
    std::nth_element(radii.begin(), half, radii.end());
    return *half;
}

}  // namespace

void add_light(CLI::App& command, AnalysisOptions& options) {
    command.add_option("--light", options.light,
                       "wavelengths in nm with their weights, as 450:0.3,550:1,650:0.5, or 550 "
                       "(default: F, d and C in equal parts)");
}

std::vector<LightLine> light_of(const AnalysisOptions& o, const camera::Lens& lens) {
    std::vector<LightLine> out;
    if (o.light.empty())
        for (const camera::SpectralLine& line : camera::kSpectralLines)
            out.push_back({line.name, line.nm, 1});
    else
        for (const std::string_view part : io::split(o.light, ',')) {
            const auto words = io::split(part, ':');
            if (words.size() > 2)
                throw ValueError("--light", o.light + " is not like 450:0.3,550:1,650:0.5");
            const double nm =
                parse_number("--light", std::string(words[0]), {kLeast_nm, kMost_nm, kNanometres});
            const double weight =
                words.size() < 2 ? 1 : parse_number("--light", std::string(words[1]), {1e-9, 1e9});
            out.push_back({fmt::format("{:g} nm", nm), nm, weight});
            warn_beyond_range(lens, nm);
        }
    double sum = 0;
    for (const LightLine& line : out) sum += line.weight;
    for (LightLine& line : out) line.weight /= sum;
    return out;
}

std::vector<double> weights_of(const std::vector<LightLine>& light) {
    std::vector<double> out;
    for (const LightLine& line : light) out.push_back(line.weight);
    return out;
}

double ray_contrast(const std::vector<std::vector<camera::BundleRay>>& rays,
                    const std::vector<LightLine>& light, double cycles_per_mm,
                    camera::Section along) {
    std::complex<double> sum;
    for (size_t i = 0; i < light.size(); ++i)
        sum += light[i].weight * camera::geometric_transfer(rays[i], cycles_per_mm, along);
    return std::abs(sum);
}

camera::PupilGrid require_grid(const camera::AimedBundle& bundle,
                               const camera::ReferenceSphere& sphere, double depth_mm) {
    const auto grid = camera::pupil_grid(bundle, sphere, depth_mm);
    if (!grid)
        throw io::ArgumentError(bundle.lens().prescription().name, "",
                                "the rays of the field {:g}° leave it parallel: there is no image",
                                bundle.object().field_deg);
    return *grid;
}

std::vector<camera::PupilFunction> field_waves(const FieldSetup& setup, double field_deg,
                                               const std::vector<LightLine>& light,
                                               double depth_mm) {
    std::vector<camera::AimedBundle> bundles;
    for (const LightLine& line : light) bundles.push_back(aim(setup, field_deg, line.nm));
    const auto image_mm = middle_of(setup, field_deg, bundles, light);
    std::vector<camera::PupilFunction> out;
    for (const camera::AimedBundle& bundle : bundles) {
        const camera::ReferenceSphere sphere =
            camera::reference_sphere(bundle, setup.film_mm, image_mm);
        const camera::PupilGrid grid = require_grid(bundle, sphere, depth_mm);
        if (!grid.resolves()) return {};
        out.push_back(camera::pupil_function(bundle, sphere, grid));
    }
    return out;
}

std::vector<camera::PupilFunction> require_waves(const FieldSetup& setup, double field_deg,
                                                 const std::vector<LightLine>& light,
                                                 double depth_mm) {
    auto out = field_waves(setup, field_deg, light, depth_mm);
    if (out.empty())
        throw io::ArgumentError(setup.lens->prescription().name, "",
                                "the wave of the field {:g}° bends too much for a grid of {} x {} "
                                "cells, and rays alone are near the truth; give a higher --fstop",
                                field_deg, camera::kMostPupilSide, camera::kMostPupilSide);
    return out;
}

WaveContrast::WaveContrast(const std::vector<camera::PupilFunction>& waves,
                           const std::vector<LightLine>& light) {
    for (size_t i = 0; i < waves.size(); ++i) {
        const camera::PointSpread spread = camera::point_spread(waves[i], 2 * waves[i].grid.side);
        lines_.push_back({camera::line_spread(spread, camera::Section::X),
                          camera::line_spread(spread, camera::Section::Y)});
        weights_.push_back(light[i].weight);
    }
}

double WaveContrast::at(double cycles_per_mm, camera::Section along) const {
    if (cycles_per_mm == 0) return 1;
    std::complex<double> sum;
    for (size_t i = 0; i < lines_.size(); ++i)
        sum += weights_[i] *
               camera::transfer(lines_[i][along == camera::Section::X ? 0 : 1], cycles_per_mm);
    return std::abs(sum);
}

void print_wave_spots(const FieldSetup& setup) {
    constexpr int side = 100, finest = 1024;
    constexpr double alike = 1.05;
    const std::vector<LightLine> line_d{{"d", kLineD_nm, 1}};
    fmt::print("half of line d's light lies within, by rays and by waves (µm):\n");
    for (const double deg : setup.fields_deg) {
        const auto rays = traced(aim(setup, deg, kLineD_nm), setup.film_mm, side);
        const auto waves = field_waves(setup, deg, line_d);
        if (waves.empty()) {
            fmt::print(
                "{:>10.4g} {:>12.4f} {:>12}  the wave bends too much to tell: rays are "
                "near the truth\n",
                deg, kMicrons * radius_of_half_mm(rays, camera::spot_size(rays).centroid_mm), "");
            continue;
        }
        const camera::PupilFunction& wave = waves[0];
        const double by_rays = radius_of_half_mm(rays, wave.sphere.image_mm);
        const std::array spread{camera::point_spread(wave, std::max(finest, 2 * wave.grid.side))};
        const double by_waves =
            camera::radii_of_shares_mm(spread, weights_of(line_d), std::array{0.5})[0];
        const double airy_mm =
            camera::airy_radius_mm(kLineD_nm, camera::wavefront_figures(wave).fnumber);
        fmt::print("{:>10.4g} {:>12.4f} {:>12.4f}  {}; Airy's disc has a radius of {:.4f}\n", deg,
                   kMicrons * by_rays, kMicrons * by_waves,
                   by_waves < alike * by_rays
                       ? "rays alone are enough"
                       : fmt::format("rays alone are {:.3g} times too sharp", by_waves / by_rays),
                   kMicrons * airy_mm);
    }
}

void print_wave_contrast(const FieldSetup& setup, const std::vector<LightLine>& light,
                         double cycles_per_mm, const std::vector<std::array<double, 2>>& rays) {
    constexpr double alike = 0.02;
    fmt::print("contrast at {:g} cycles per mm, by rays and by waves, tangential and sagittal:\n",
               cycles_per_mm);
    for (size_t i = 0; i < rays.size(); ++i) {
        const double deg = setup.fields_deg[i];
        fmt::print("{:>10.4g} {:>7.3f} {:>7.3f}", deg, rays[i][0], rays[i][1]);
        const auto waves = field_waves(setup, deg, light);
        if (waves.empty()) {
            fmt::print(" {:>7} {:>7}  the wave bends too much to tell: rays are near the truth\n",
                       "", "");
            continue;
        }
        const WaveContrast contrast(waves, light);
        const double t = contrast.at(cycles_per_mm, setup.section),
                     s = contrast.at(cycles_per_mm, across(setup));
        const double most = std::max(rays[i][0] - t, rays[i][1] - s);
        fmt::print(" {:>7.3f} {:>7.3f}  {}\n", t, s,
                   most < alike ? "rays alone are enough"
                                : fmt::format("rays alone are too sharp by {:.3f}", most));
    }
}

}  // namespace petzval::apps
