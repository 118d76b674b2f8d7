// SPDX-License-Identifier: Apache-2.0
// petzval lens wavefront, psf.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/commands/lens/waves.h"
#include "io/base/error.h"

namespace petzval::apps {
namespace {

constexpr int kZernikes = 22;  // up to spherical aberration of the fifth order

// Wave of a line at a field, about the point where it is least.
struct LineWave {
    camera::AimedBundle bundle;
    camera::PupilFunction pupil;
    camera::WavefrontFigures figures;
};

LineWave least_wave(const FieldSetup& setup, double field_deg, double nm) {
    camera::AimedBundle bundle = aim(setup, field_deg, nm);
    auto image_mm = camera::image_point(bundle, setup.film_mm);
    if (!image_mm) refuse_dark(*setup.lens, field_deg);
    for (int i = 0;; ++i) {
        const camera::ReferenceSphere sphere =
            camera::reference_sphere(bundle, setup.film_mm, *image_mm);
        camera::PupilFunction pupil = camera::pupil_function(
            bundle, sphere, require_grid(bundle, sphere).with_side(camera::kFiguresPupilSide));
        const camera::WavefrontFigures figures = camera::wavefront_figures(pupil);
        if (!(figures.rms_mm >= 0)) refuse_dark(*setup.lens, field_deg);
        if (i == 1) return {std::move(bundle), std::move(pupil), figures};
        image_mm = figures.image_mm;
    }
}

std::string figures_row(double field_deg, const LightLine& line, const LineWave& wave) {
    const double wavelength_mm = wave.pupil.wavelength_mm();
    return fmt::format(
        "{:>10.4g} {:>8} {:>11.6f} {:>11.6f} {:>10.4f} {:>10.4f} {:>8.4f} {:>9.3f}\n", field_deg,
        line.name, shown(wave.figures.image_mm[0]), shown(wave.figures.image_mm[1]),
        wave.figures.rms_mm / wavelength_mm, wave.figures.peak_to_valley_mm / wavelength_mm,
        wave.figures.strehl, wave.figures.fnumber);
}

void print_zernikes(const std::vector<std::string>& heads,
                    const std::vector<std::vector<double>>& columns) {
    fmt::print(
        "\nZernike coefficients, waves (Noll 1976; the unit circle is the rim of the iris)\n"
        "{:>4}",
        "");
    for (const std::string& head : heads) fmt::print(" {:>12}", head);
    for (size_t j = 1; j < kZernikes; ++j) {
        fmt::print("\n{:>4}", fmt::format("Z{}", j + 1));
        for (const auto& column : columns)  // not -0.0000
            fmt::print(" {:>12.4f}", std::fabs(column[j]) < 5e-5 ? 0 : column[j]);
    }
    fmt::print("\n");
}

// Map of the opd over the pupil, as seen from the image point; `from` is where it begins, and then
// where it ends.
void add_map(io::Plot& plot, const camera::PupilFunction& pupil, double& from) {
    io::PlotSeries cells{.style = io::PlotStyle::Cells};
    const double half = pupil.grid.step * pupil.grid.side / 2;
    const auto middle = pupil.cosines(pupil.light.size() / 2 + size_t(pupil.grid.side) / 2);
    for (size_t cell = 0; cell < pupil.light.size(); ++cell) {
        const auto [p, q] = pupil.cosines(cell);
        cells.points.push_back({from + half + p - middle[0], q - middle[1]});
        cells.values.push_back(
            pupil.amplitude[cell] > 0 ? pupil.opd_mm[cell] / pupil.wavelength_mm() : NAN);
    }
    from += 2 * half;
    plot.series.push_back(std::move(cells));
}

std::string listed(const std::vector<double>& fields_deg) {
    return fmt::format("{:.4g}°", fmt::join(fields_deg, "°, "));
}

Found wavefront_analysis(const AnalysisOptions& o) {
    const FieldSetup setup = set_up_lit(o.field, {0, 0.7, 1});
    const auto light = light_of(o, *setup.lens);
    Found out;
    out.names = {"field_deg", "nm", "tangential", "stop_radii", "opd_mm"};
    io::Plot maps{
        .title = title_of(*setup.lens,
                          fmt::format("wavefront at {}, fields {}, left to right",
                                      light[light.size() / 2].name, listed(setup.fields_deg))),
        .x_label = "p (direction cosines, side by side)",
        .y_label = "q from the middle (direction cosine)",
        .series = {},
        .equal_scale = true,
        .value_label = "ahead of the sphere (waves)"};
    double maps_end = 0;
    std::vector<std::string> heads;
    std::vector<std::vector<double>> columns;
    std::string table = fmt::format(
        "film at {:.6f} mm\n{:>10} {:>8} {:>11} {:>11} {:>10} {:>10} {:>8} {:>9}\n", setup.film_mm,
        "field (°)", "line", "x (mm)", "y (mm)", "RMS (λ)", "P-V (λ)", "Strehl", "f-number");
    for (const double deg : setup.fields_deg) {
        // All fans of a field about the point of the middle line, which shows lateral colour.
        const auto centre = least_wave(setup, deg, light[light.size() / 2].nm);
        for (const LightLine& line : light) {
            const LineWave wave = least_wave(setup, deg, line.nm);
            table += figures_row(deg, line, wave);
            heads.push_back(fmt::format("{:.4g}° {}", deg, line.name));
            columns.push_back(camera::zernike_coefficients_mm(wave.pupil, kZernikes));
            for (double& c : columns.back()) c /= wave.pupil.wavelength_mm();
            const camera::ReferenceSphere sphere =
                camera::reference_sphere(wave.bundle, setup.film_mm, centre.figures.image_mm);
            for (const camera::Section along : {setup.section, across(setup)}) {
                const bool tangential = along == setup.section;
                io::PlotSeries fan{.style = io::PlotStyle::Lines,
                                   .label = fmt::format("{:.4g}° {} {}", deg, line.name,
                                                        tangential ? "tangential" : "sagittal")};
                for (const camera::OpdPoint& point : camera::opd_fan(wave.bundle, sphere, along)) {
                    fan.points.push_back({point.stop, point.opd_mm / wave.pupil.wavelength_mm()});
                    out.rows.push_back(
                        {deg, line.nm, double(tangential), point.stop, point.opd_mm});
                }
                out.plot.series.push_back(std::move(fan));
            }
        }
        add_map(maps, centre.pupil, maps_end);
    }
    fmt::print("{}", table);
    print_zernikes(heads, columns);
    if (!o.map.empty()) io::write_plot(o.map, maps);
    out.plot.title = title_of(*setup.lens, "wavefront fans");
    out.plot.x_label = "where the ray crosses the stop (radii)";
    out.plot.y_label = "ahead of the reference sphere (waves)";
    return out;
}

// Light per mm^2 of all lines together at a point about the image point.
double white_per_mm2(const std::vector<camera::PointSpread>& spreads,
                     const std::vector<LightLine>& light, double x_mm, double y_mm) {
    double sum = 0;
    for (size_t i = 0; i < spreads.size(); ++i)
        sum += light[i].weight * spreads[i].per_mm2(x_mm, y_mm);
    return sum;
}

Found psf_analysis(const AnalysisOptions& o) {
    constexpr int drawn = 128, finest = 1024;
    constexpr double least = 1e-4;  // of the peak
    const FieldSetup setup = set_up_lit(o.field, {0, 0.7, 1});
    const auto light = light_of(o, *setup.lens);
    Found out;
    out.names = {"field_deg", "x_mm", "y_mm", "per_mm2"};
    std::vector<std::vector<camera::PointSpread>> of_field;
    double half_mm = 0, window_mm = INFINITY;
    std::string table =
        fmt::format("film at {:.6f} mm\n{:>10} {:>11} {:>11} {:>14} {:>14} {:>14}\n", setup.film_mm,
                    "field (°)", "x (mm)", "y (mm)", "half in (µm)", "80 % in (µm)", "Airy (µm)");
    for (const double deg : setup.fields_deg) {
        const auto waves = require_waves(setup, deg, light);
        std::vector<camera::PointSpread> spreads;
        double airy_mm = 0;
        for (size_t i = 0; i < waves.size(); ++i) {
            spreads.push_back(
                camera::point_spread(waves[i], std::max(finest, 2 * waves[i].grid.side)));
            airy_mm +=
                light[i].weight *
                camera::airy_radius_mm(light[i].nm, camera::wavefront_figures(waves[i]).fnumber);
            window_mm = std::min(window_mm, spreads[i].step_mm * (spreads[i].side / 2 - 1));
        }
        const auto radii_mm =
            camera::radii_of_shares_mm(spreads, weights_of(light), std::array{0.5, 0.8});
        const auto& image_mm = waves[0].sphere.image_mm;
        table += fmt::format("{:>10.4g} {:>11.6f} {:>11.6f} {:>14.4f} {:>14.4f} {:>14.4f}\n", deg,
                             shown(image_mm[0]), shown(image_mm[1]), kMicrons * radii_mm[0],
                             kMicrons * radii_mm[1], kMicrons * airy_mm);
        half_mm = std::max({half_mm, 4 * airy_mm, 1.5 * radii_mm[1]});
        of_field.push_back(std::move(spreads));
    }
    fmt::print("{}", table);
    half_mm = std::min(half_mm, window_mm);
    for (size_t field = 0; field < of_field.size(); ++field) {
        io::PlotSeries cells{.style = io::PlotStyle::Cells};
        double peak = 0;
        for (int j = 0; j < drawn; ++j)
            for (int i = 0; i < drawn; ++i) {
                const double x = half_mm * ((2 * i + 1.) / drawn - 1),
                             y = half_mm * ((2 * j + 1.) / drawn - 1);
                const double here = white_per_mm2(of_field[field], light, x, y);
                peak = std::max(peak, here);
                out.rows.push_back({setup.fields_deg[field], x, y, here});
                cells.points.push_back(
                    {kMicrons * (x + 2.1 * half_mm * double(field)), kMicrons * y});
                cells.values.push_back(here);
            }
        for (double& value : cells.values) value = std::log10(std::max(value / peak, least));
        out.plot.series.push_back(std::move(cells));
    }
    out.plot.title = title_of(
        *setup.lens,
        fmt::format("point spread of the fields {}, left to right", listed(setup.fields_deg)));
    out.plot.x_label = "x from each image point (µm)";
    out.plot.y_label = "y from the image point (µm)";
    out.plot.equal_scale = true;
    out.plot.value_label = "light against each peak (powers of 10)";
    return out;
}

}  // namespace

void add_lens_wave_commands(CLI::App& lens) {
    const auto wavefront = add_analysis(
        lens, "wavefront", "wavefront error: fans, maps, RMS, Strehl ratio, Zernike coefficients",
        true, wavefront_analysis,
        "Optical path difference against the reference sphere through the exit pupil, above 0 "
        "where the wave is ahead. Figures are about the point on the film where the RMS is least "
        "(mean and tilt taken out), fans about that of the middle line. Strehl: light at that "
        "point over that of a wave without error.");
    add_light(*lens.get_subcommand("wavefront"), *wavefront);
    lens.get_subcommand("wavefront")
        ->add_option("--map", wavefront->map,
                     "maps of the pupil to write too, of the middle line, .svg or .png");
    const auto psf = add_analysis(
        lens, "psf", "images of points by waves", true, psf_analysis,
        "By a Fourier transform of the wave in the exit pupil. The radii that hold half and 80 % "
        "of the light are about the middle of the light; Airy: the dark ring of a lens without "
        "errors.");
    add_light(*lens.get_subcommand("psf"), *psf);
}

}  // namespace petzval::apps
