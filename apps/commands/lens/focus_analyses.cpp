// SPDX-License-Identifier: Apache-2.0
// petzval lens through-focus, field-curvature, focal-shift, lateral-colour.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/cli/readers.h"
#include "apps/commands/lens/waves.h"
#include "camera/bench/analysis.h"
#include "camera/bench/field_focus.h"
#include "io/base/error.h"

namespace petzval::apps {
namespace {

std::vector<double> shares_from(int first, int steps) {
    std::vector<double> out;
    for (int i = first; i <= steps; ++i) out.push_back(double(i) / steps);
    return out;
}

double open_fnumber(const camera::Lens& lens) {
    const auto stop = static_cast<size_t>(lens.stop());
    return camera::fnumber_of(lens, lens.prescription().surfaces[stop].semi_diameter_mm);
}

// Films at which a field is looked at: contrast has gone at the ends, and foci lie between.
double depth_of(const FieldSetup& setup, double cycles) {
    const double blur_mm = 2 * open_fnumber(*setup.lens) / cycles;
    double off_mm = 0;
    for (const double deg : setup.fields_deg)
        if (const auto focus = camera::field_focus(aim(setup, deg, kLineD_nm), setup.film_mm))
            off_mm =
                std::max({off_mm, std::fabs(focus->tangential_mm), std::fabs(focus->sagittal_mm)});
    const double depth_mm = blur_mm + std::min(off_mm, 5 * blur_mm);
    if (!std::isfinite(depth_mm))
        throw io::ArgumentError(setup.lens->prescription().name, "",
                                "no ray along the axis reaches the film");
    return depth_mm;
}

std::vector<camera::BundleRay> moved_rays(std::vector<camera::BundleRay> rays, double shift_mm) {
    for (camera::BundleRay& ray : rays)
        for (size_t k = 0; k < 2; ++k) ray.film_mm[k] += shift_mm * ray.slope[k];
    return rays;
}

Found through_focus_analysis(const AnalysisOptions& o) {
    constexpr int side = 48, steps = 20;
    const FieldSetup setup = set_up_lit(o.field, {0, 0.7, 1});
    const auto light = light_of(o, *setup.lens);
    const double depth_mm = depth_of(setup, o.most_cycles);
    Found out;
    out.names = {"field_deg", "shift_mm", "tangential", "sagittal", "rms_mm"};
    fmt::print("film at {:.6f} mm\n{:>10} {:>17} {:>17} {:>17}\n", setup.film_mm, "field (°)",
               "least RMS at (mm)", "tangential (mm)", "sagittal (mm)");
    std::vector<std::vector<std::vector<camera::BundleRay>>> rays;  // by field, by line
    for (const double deg : setup.fields_deg) {
        rays.emplace_back();
        std::vector<camera::BundleRay> all;
        for (const LightLine& line : light) {
            rays.back().push_back(traced(aim(setup, deg, line.nm), setup.film_mm, side));
            if (rays.back().back().empty()) refuse_dark(*setup.lens, deg);
            all.insert(all.end(), rays.back().back().begin(), rays.back().back().end());
        }
        const auto waves = o.wave ? require_waves(setup, deg, light, depth_mm)
                                  : std::vector<camera::PupilFunction>();
        const auto contrast_at = [&](double shift_mm) {
            if (o.wave) {
                std::vector<camera::PupilFunction> there;
                for (const camera::PupilFunction& wave : waves)
                    there.push_back(camera::moved(wave, shift_mm));
                const WaveContrast contrast(there, light);
                return std::array{contrast.at(o.most_cycles, setup.section),
                                  contrast.at(o.most_cycles, across(setup))};
            }
            std::vector<std::vector<camera::BundleRay>> there;
            for (const auto& of_line : rays.back()) there.push_back(moved_rays(of_line, shift_mm));
            return std::array{ray_contrast(there, light, o.most_cycles, setup.section),
                              ray_contrast(there, light, o.most_cycles, across(setup))};
        };
        std::array<std::array<double, 2>, 2> best{};  // shift and contrast
        io::PlotSeries lines[2];
        for (size_t k = 0; k < 2; ++k)
            lines[k].label = fmt::format("{:.4g}° {}", deg, k ? "sagittal" : "tangential");
        for (int i = -steps; i <= steps; ++i) {
            const double shift_mm = depth_mm * i / steps;
            const auto contrast = contrast_at(shift_mm);
            for (size_t k = 0; k < 2; ++k) {
                lines[k].points.push_back({shift_mm, contrast[k]});
                if (contrast[k] > best[k][1]) best[k] = {shift_mm, contrast[k]};
            }
            out.rows.push_back(
                {deg, shift_mm, contrast[0], contrast[1], camera::spot_size(all, shift_mm).rms_mm});
        }
        fmt::print("{:>10.4g} {:>17.4f} {:>9.4f} ({:>5.3f}) {:>9.4f} ({:>5.3f})\n", deg,
                   camera::best_shift_mm(all), best[0][0], best[0][1], best[1][0], best[1][1]);
        for (io::PlotSeries& line : lines) out.plot.series.push_back(std::move(line));
    }
    out.plot.title = title_of(
        *setup.lens,
        fmt::format("{} MTF at {:g} cycles per mm", o.wave ? "wave" : "geometric", o.most_cycles));
    out.plot.x_label = "film shifted away from the lens (mm)";
    out.plot.y_label = "contrast";
    return out;
}

// A diagram of what is found at each x: a series for each name, times a factor for the eye.
Found curves(const std::string& title, const char* x_label, const char* y_label,
             std::vector<std::string> names, std::vector<std::vector<double>> rows,
             double factor = 1) {
    Found out{{title, x_label, y_label, {}}, std::move(names), std::move(rows)};
    for (size_t k = 1; k < out.names.size(); ++k) {
        io::PlotSeries series{.label = out.names[k].substr(0, out.names[k].rfind('_'))};
        for (const auto& row : out.rows) series.points.push_back({row[0], factor * row[k]});
        out.plot.series.push_back(std::move(series));
    }
    return out;
}

Found field_curvature_analysis(const AnalysisOptions& o) {
    const FieldSetup setup = set_up_lit(o.field, shares_from(0, 40));
    std::vector<std::vector<double>> rows;
    for (const double deg : setup.fields_deg) {
        const auto bundle = camera::AimedBundle::aim(
            *setup.lens, {deg, setup.distance_mm, setup.section}, kLineD_nm);
        if (const auto focus = bundle ? camera::field_focus(*bundle, setup.film_mm) : std::nullopt)
            rows.push_back({deg, focus->tangential_mm, focus->sagittal_mm});
    }
    return curves(title_of(*setup.lens, "field curvature and astigmatism, line d"),
                  "field (degrees)", "focus behind the film (mm)",
                  {"field_deg", "tangential_mm", "sagittal_mm"}, std::move(rows));
}

Found focal_shift_analysis(const AnalysisOptions& o) {
    constexpr int first_nm = 400, last_nm = 700, step_nm = 5, side = 64;
    const FieldSetup setup = set_up_lit(o.field, {});
    const camera::Lens& lens = *setup.lens;
    const double object_mm =
        camera::first_order(lens, kLineD_nm).entrance_pupil_mm - setup.distance_mm;
    std::vector<std::vector<double>> rows;
    for (int nm = first_nm; nm <= last_nm; nm += step_nm) {
        const double image_mm =
            std::isfinite(object_mm)
                ? camera::image_of(lens, object_mm, nm, setup.section).from_last_vertex_mm
                : camera::first_order(lens, nm, setup.section).back_focus_mm;
        const auto rays = traced(aim(setup, 0, nm), setup.film_mm, side);
        if (rays.empty()) refuse_dark(lens, 0);
        rows.push_back({double(nm), lens.vertex_mm(lens.last()) + image_mm - setup.film_mm,
                        camera::best_shift_mm(rays)});
    }
    return curves(title_of(lens, "chromatic focal shift on the axis"), "wavelength (nm)",
                  "focus behind the film (mm)", {"nm", "paraxial_mm", "least_spot_mm"},
                  std::move(rows));
}

Found lateral_colour_analysis(const AnalysisOptions& o) {
    const FieldSetup setup = set_up_lit(o.field, shares_from(0, 40));
    const double airy_mm = camera::airy_radius_mm(kLineD_nm, open_fnumber(*setup.lens));
    std::vector<std::vector<double>> rows;
    for (const double deg : setup.fields_deg) {
        const auto height = [&](double nm) {
            return camera::chief_height_mm(*setup.lens, {deg, setup.distance_mm, setup.section},
                                           setup.film_mm, nm);
        };
        const auto f = height(kLineF_nm), d = height(kLineD_nm), c = height(kLineC_nm);
        if (f && d && c) rows.push_back({deg, *f - *d, *c - *d, airy_mm, -airy_mm});
    }
    Found out = curves(title_of(*setup.lens, "lateral colour"), "field (degrees)",
                       "chief ray from that of line d on the film (µm)",
                       {"field_deg", "F_mm", "C_mm", "airy_mm", "minus_airy_mm"}, std::move(rows),
                       kMicrons);
    for (const size_t k : {2, 3}) {
        out.plot.series[k].style = io::PlotStyle::Dashes;
        out.plot.series[k].grey = true;
        out.plot.series[k].label = k == 2 ? "radius of Airy's disc" : "";
    }
    return out;
}

}  // namespace

void add_lens_focus_commands(CLI::App& lens) {
    const auto through = add_analysis(
        lens, "through-focus", "contrast and spots as the film moves", true, through_focus_analysis,
        "MTF at one frequency, tangential and sagittal. The table says where spots are smallest "
        "and contrast is greatest, and how great.");
    CLI::App& command = *lens.get_subcommand("through-focus");
    through->most_cycles = 30;
    command.add_option("--cycles", through->most_cycles, "frequency, cycles per mm, default 30")
        ->transform(number_between(1e-3, 1e5));
    command.add_flag("--wave", through->wave, "by waves (default: by rays alone)");
    add_light(command, *through);
    add_analysis(lens, "field-curvature", "sagittal and tangential focus over the field", true,
                 field_curvature_analysis,
                 "Of line d, by rays close to the one through the middle of the stop; between the "
                 "two lies the astigmatism.");
    add_analysis(lens, "focal-shift", "focus on the axis over the wavelength", false,
                 focal_shift_analysis,
                 "Paraxial, and where the spot of the whole iris is smallest; 400 to 700 nm.");
    add_analysis(lens, "lateral-colour", "heights of F and C on the film against that of d", true,
                 lateral_colour_analysis,
                 "Of the ray through the middle of the stop. The dashes are Airy's disc on the "
                 "axis, which hides what is smaller.");
}

}  // namespace petzval::apps
