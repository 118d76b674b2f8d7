// SPDX-License-Identifier: Apache-2.0
// petzval lens spot, fan, mtf, distortion, vignetting.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/cli/console.h"
#include "apps/cli/readers.h"
#include "apps/commands/lens/analysis.h"
#include "apps/commands/lens/waves.h"
#include "camera/bench/analysis.h"
#include "io/base/error.h"

namespace petzval::apps {
namespace {

void append(std::vector<camera::BundleRay>& all, const std::vector<camera::BundleRay>& more) {
    all.insert(all.end(), more.begin(), more.end());
}

void print_spot(double field_deg, const char* line, const camera::SpotSize& size) {
    fmt::print("{:>10.4g} {:>6} {:>12.6f} {:>12.6f} {:>12.4f}\n", field_deg, line,
               shown(size.centroid_mm[0]), shown(size.centroid_mm[1]), kMicrons * size.rms_mm);
}

Found spot_analysis(const AnalysisOptions& o) {
    constexpr int side = 300, drawn_side = 28;
    const FieldSetup setup = set_up_lit(o.field, {0, 0.7, 1});
    Found out;
    out.names = {"field_deg", "nm", "x_mm", "y_mm"};
    std::vector<io::PlotSeries> series;
    for (const camera::SpectralLine& line : camera::kSpectralLines)
        series.push_back({{}, io::PlotStyle::Dots, line.name});
    fmt::print("film at {:.6f} mm\n{:>10} {:>6} {:>12} {:>12} {:>12}\n", setup.film_mm, "field (°)",
               "line", "x (mm)", "y (mm)", "RMS (µm)");
    std::vector<std::vector<std::vector<camera::BundleRay>>> drawn;  // by field, by line
    std::vector<camera::SpotSize> sizes;
    double reach_mm = 1e-6;
    for (const double deg : setup.fields_deg) {
        std::vector<camera::BundleRay> all;
        drawn.emplace_back();
        for (const camera::SpectralLine& line : camera::kSpectralLines) {
            const camera::AimedBundle bundle = aim(setup, deg, line.nm);
            const auto rays = traced(bundle, setup.film_mm, side);
            if (rays.empty()) refuse_dark(*setup.lens, deg);
            print_spot(deg, line.name, camera::spot_size(rays));
            append(all, rays);
            drawn.back().push_back(traced(bundle, setup.film_mm, drawn_side));
        }
        sizes.push_back(camera::spot_size(all));
        print_spot(deg, "F+d+C", sizes.back());
        for (const auto& rays : drawn.back())
            for (const camera::BundleRay& ray : rays)
                for (size_t k = 0; k < 2; ++k)
                    reach_mm =
                        std::max(reach_mm, std::fabs(ray.film_mm[k] - sizes.back().centroid_mm[k]));
    }
    print_wave_spots(setup);
    std::string fields;
    for (size_t i = 0; i < drawn.size(); ++i) {
        fields += fmt::format("{}{:.4g}°", i ? ", " : "", setup.fields_deg[i]);
        const double aside_mm = 2.4 * reach_mm * static_cast<double>(i);
        for (size_t line = 0; line < camera::kSpectralLines.size(); ++line)
            for (const camera::BundleRay& ray : drawn[i][line]) {
                out.rows.push_back({setup.fields_deg[i], camera::kSpectralLines[line].nm,
                                    ray.film_mm[0], ray.film_mm[1]});
                series[line].points.push_back(
                    {kMicrons * (ray.film_mm[0] - sizes[i].centroid_mm[0] + aside_mm),
                     kMicrons * (ray.film_mm[1] - sizes[i].centroid_mm[1])});
            }
    }
    out.plot = {.title = title_of(*setup.lens, "spots of the fields " + fields + ", left to right"),
                .x_label = "x from each centroid (µm)",
                .y_label = "y from the centroid (µm)",
                .series = std::move(series),
                .equal_scale = true};
    return out;
}

Found fan_analysis(const AnalysisOptions& o) {
    const FieldSetup setup = set_up_lit(o.field, {0.7});
    Found out;
    out.names = {"field_deg", "nm", "tangential", "stop_radii", "dx_mm", "dy_mm"};
    for (const double deg : setup.fields_deg) {
        const camera::AimedBundle main = aim(setup, deg, kLineD_nm);
        const camera::PupilPoint chief = main.chief();
        const auto centre = main.trace({&chief, 1}, setup.film_mm, camera::Clip::No);
        if (centre.empty()) refuse_dark(*setup.lens, deg);
        for (const camera::Section along : {setup.section, across(setup)})
            for (const camera::SpectralLine& line : camera::kSpectralLines) {
                const bool tangential = along == setup.section;
                io::PlotSeries series{{}, io::PlotStyle::Lines, {}};
                series.label = fmt::format("{:.4g}° {} {}", deg, line.name,
                                           tangential ? "tangential" : "sagittal");
                const camera::AimedBundle bundle = aim(setup, deg, line.nm);
                const auto fan =
                    camera::ray_fan(*setup.lens, bundle, along, setup.film_mm, centre[0].film_mm);
                if (fan.empty()) refuse_dark(*setup.lens, deg);
                for (const camera::FanPoint& point : fan) {
                    series.points.push_back(
                        {point.stop,
                         kMicrons * point.from_mm[along == camera::Section::X ? 0 : 1]});
                    out.rows.push_back({deg, line.nm, double(tangential), point.stop,
                                        point.from_mm[0], point.from_mm[1]});
                }
                out.plot.series.push_back(std::move(series));
            }
    }
    out.plot.title = title_of(*setup.lens, "ray fans");
    out.plot.x_label = "where the ray crosses the stop (radii)";
    out.plot.y_label = "from the chief ray of line d on the film (µm)";
    return out;
}

Found mtf_analysis(const AnalysisOptions& o) {
    constexpr int side = 100, steps = 50;
    const FieldSetup setup = set_up_lit(o.field, {0, 0.7, 1});
    const auto light = light_of(o, *setup.lens);
    Found out;
    out.names = {"field_deg", "cycles_per_mm", "tangential", "sagittal"};
    std::vector<std::array<double, 2>> halfway;  // by rays, at half of the highest frequency
    for (const double deg : setup.fields_deg) {
        std::vector<std::vector<camera::BundleRay>> rays;
        for (const LightLine& line : light) {
            rays.push_back(traced(aim(setup, deg, line.nm), setup.film_mm, side));
            if (rays.back().empty()) refuse_dark(*setup.lens, deg);
        }
        std::optional<WaveContrast> waves;
        if (o.wave) waves.emplace(require_waves(setup, deg, light), light);
        const auto contrast = [&](double cycles, camera::Section along) {
            return waves ? waves->at(cycles, along) : ray_contrast(rays, light, cycles, along);
        };
        io::PlotSeries tangential{{}, io::PlotStyle::Lines, fmt::format("{:.4g}° tangential", deg)};
        io::PlotSeries sagittal{{}, io::PlotStyle::Lines, fmt::format("{:.4g}° sagittal", deg)};
        for (int i = 0; i <= steps; ++i) {
            const double cycles = o.most_cycles * i / steps;
            const double t = contrast(cycles, setup.section), s = contrast(cycles, across(setup));
            tangential.points.push_back({cycles, t});
            sagittal.points.push_back({cycles, s});
            out.rows.push_back({deg, cycles, t, s});
        }
        halfway.push_back({ray_contrast(rays, light, o.most_cycles / 2, setup.section),
                           ray_contrast(rays, light, o.most_cycles / 2, across(setup))});
        out.plot.series.push_back(std::move(tangential));
        out.plot.series.push_back(std::move(sagittal));
    }
    print_wave_contrast(setup, light, o.most_cycles / 2, halfway);
    std::string lines;
    for (const LightLine& line : light) lines += (lines.empty() ? "" : " + ") + line.name;
    out.plot.title =
        title_of(*setup.lens, (o.wave ? "wave MTF, " : "geometric MTF (no diffraction), ") + lines);
    out.plot.x_label = "cycles per mm on the film";
    out.plot.y_label = "contrast";
    return out;
}

// Says which fields are not in the plot. Those of a default, in steps, are named by their ends.
void say_left_out(const std::vector<double>& fields_deg, const std::string& why) {
    constexpr size_t most_named = 6;
    if (fields_deg.empty()) return;
    const std::string which =
        fields_deg.size() > most_named
            ? fmt::format("{:.4g}° to {:.4g}° ({} fields)", fields_deg.front(), fields_deg.back(),
                          fields_deg.size())
            : fmt::format("{:.4g}°", fmt::join(fields_deg, "°, "));
    print_notice(fmt::format("warning: left out: {}: {}", which, why));
}

Found distortion_analysis(const AnalysisOptions& o) {
    constexpr double widest_deg = 89;
    std::vector<double> shares;
    for (int i = 1; i <= 40; ++i) shares.push_back(i / 40.);
    const FieldSetup setup = set_up_lit(o.field, shares);
    Found out;
    out.names = {"field_deg", "height_mm", "ideal_height_mm", "distortion"};
    io::PlotSeries series{{}, io::PlotStyle::LinesAndPoints, {}};
    std::vector<double> on_axis, too_wide, dark;
    for (const double deg : setup.fields_deg) {
        if (deg <= 0 || deg > widest_deg) {
            (deg <= 0 ? on_axis : too_wide).push_back(deg);
            continue;
        }
        const auto found =
            camera::distortion(*setup.lens, deg, setup.film_mm, setup.distance_mm, setup.section);
        if (!found) {
            dark.push_back(deg);
            continue;
        }
        out.rows.push_back({deg, found->height_mm, found->ideal_height_mm, found->relative()});
        series.points.push_back({deg, 100 * found->relative()});
    }
    say_left_out(on_axis, "the ideal height is 0 there");
    say_left_out(too_wide, fmt::format("f tan(field) grows without bounds towards 90°, and ends "
                                       "here at {:g}°",
                                       widest_deg));
    say_left_out(dark, "no ray through the middle of the stop reaches the film");
    if (out.rows.empty())
        throw io::ArgumentError(o.field.request.lens, "",
                                "no field above 0° and up to {:g}° reaches the film; give "
                                "other ones by --field",
                                widest_deg);
    out.plot = {.title = title_of(*setup.lens, "distortion at line d"),
                .x_label = "field (degrees)",
                .y_label = "height on the film against f tan(field) (%)",
                .series = {std::move(series)}};
    return out;
}

Found vignetting_analysis(const AnalysisOptions& o) {
    constexpr int steps = 32;
    const FieldSetup setup = set_up_lit(o.field, {});
    const double circle_mm =
        o.image_circle_mm > 0 ? o.image_circle_mm : setup.lens->prescription().image_circle_mm;
    if (!(circle_mm > 0))
        throw io::ArgumentError(o.field.request.lens, "",
                                "does not state its image circle; give --image-circle");
    std::vector<double> heights;
    for (int i = 0; i <= steps; ++i) heights.push_back(circle_mm / 2 * i / steps);
    const auto light = camera::film_irradiance(setup.lens, setup.film_mm, heights, setup.section);
    if (!(light[0] > 0))
        throw io::ArgumentError(o.field.request.lens, "",
                                "no light reaches the middle of the film");
    Found out;
    out.names = {"height_mm", "irradiance", "relative"};
    io::PlotSeries series{{}, io::PlotStyle::LinesAndPoints, {}};
    for (size_t i = 0; i < heights.size(); ++i) {
        out.rows.push_back({heights[i], light[i], light[i] / light[0]});
        series.points.push_back({heights[i], 100 * light[i] / light[0]});
    }
    out.plot = {.title = title_of(*setup.lens, "vignetting, line d"),
                .x_label = "height on the film (mm)",
                .y_label = "irradiance against the middle (%)",
                .series = {std::move(series)}};
    return out;
}

}  // namespace

void add_lens_analysis_commands(CLI::App& lens) {
    add_analysis(lens, "spot", "images of points, at the lines F, d, C", true, spot_analysis,
                 "RMS: root of the mean square distance from the centroid, of rays that fill the "
                 "entrance pupil evenly and pass all apertures.");
    add_analysis(lens, "fan", "transverse aberrations across the aperture", true, fan_analysis,
                 "Tangential: along the field; sagittal: across it.");
    const auto mtf = add_analysis(
        lens, "mtf", "modulation transfer by rays, or by waves", true, mtf_analysis,
        "Geometric: from rays alone, without diffraction. Tangential: contrast of lines that lie "
        "across the field. The table compares rays and waves at half of the highest frequency.");
    lens.get_subcommand("mtf")
        ->add_option("--cycles", mtf->most_cycles, "highest frequency, cycles per mm, default 100")
        ->transform(number_between(1e-3, 1e5));
    lens.get_subcommand("mtf")->add_flag("--wave", mtf->wave,
                                         "with diffraction (default: by rays alone)");
    add_light(*lens.get_subcommand("mtf"), *mtf);
    add_analysis(lens, "distortion", "heights on the film against f tan(field)", true,
                 distortion_analysis,
                 "Of the ray through the middle of the stop, line d; f is the paraxial focal "
                 "length. With --focus the paraxial magnification takes its place.");
    const auto vignetting =
        add_analysis(lens, "vignetting", "irradiance over the film against its middle", false,
                     vignetting_analysis,
                     "Of an even scene, line d: natural and mechanical vignetting and "
                     "the aberrations of the pupil together, by the camera that renders.");
    lens.get_subcommand("vignetting")
        ->add_option("--image-circle", vignetting->image_circle_mm,
                     "its diameter in mm (default: what the lens's file states)")
        ->transform(number_between(1e-3, 1e5, kMillimetres));
}

}  // namespace petzval::apps
