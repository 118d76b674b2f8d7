// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/image/image.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <limits>
#include <memory>
#include <optional>

#include "apps/cli/console.h"
#include "apps/cli/field_options.h"
#include "apps/cli/readers.h"
#include "apps/commands/image/noise.h"
#include "apps/commands/image/view.h"
#include "apps/request/parse.h"
#include "io/base/error.h"
#include "io/file/overwrite.h"
#include "io/image/difference.h"
#include "io/image/picture_files.h"
#include "io/image/spectral_layout.h"
#include "io/image/symmetric_mse.h"
#include "io/plot/plot.h"

namespace petzval::apps {
namespace {

struct DiffOptions {
    std::string a, b;
    std::optional<double> fail_above;
    RenderOrder order;
};

void print_layer(const io::LayerDifference& d) {
    std::string line = d.layer + ": ";
    if (d.symmetric_mse) line += fmt::format("symmetric MSE {:.6g}, ", *d.symmetric_mse);
    line +=
        fmt::format("RMSE {:.6g}, relative MSE {:.6g}, PSNR {:.2f} dB (peak {:.6g}), max {:.6g}",
                    d.rmse, d.relative_mse, d.psnr_db, d.peak, d.max_abs);
    if (d.max_abs > 0.) line += fmt::format(" in {} at {},{}", d.max_channel, d.max_x, d.max_y);
    if (d.not_finite > 0) line += fmt::format(", {} values not finite", d.not_finite);
    print_line(line);
}

/// Throws where a layer is further from the reference than it may be.
void require_within(double limit, const DiffOptions& o, const io::LayerDifference& d) {
    if (d.not_finite > 0)
        throw io::InputError(o.a, "", "{}: {} values are not finite in it or in {}", d.layer,
                             d.not_finite, o.b);
    if (d.rmse > limit)
        throw io::InputError(o.a, "", "{}: RMSE {:.6g} against {} is above {:g}", d.layer, d.rmse,
                             o.b, limit);
}

void diff_command(const DiffOptions& o) {
    const auto [layers, channels_of_one] =
        io::compare_files(o.a, o.b, o.order.render.scene.pictures());
    for (const io::LayerDifference& layer : layers) print_layer(layer);
    if (!channels_of_one.empty()) print_line("not compared: " + channels_of_one);
    std::fflush(stdout);  // the result comes before a complaint
    if (!o.fail_above) return;
    if (!channels_of_one.empty())
        throw io::InputError(o.a, "", "against {}: {}", o.b, channels_of_one);
    for (const io::LayerDifference& layer : layers) require_within(*o.fail_above, o, layer);
}

void add_diff(CLI::App& image) {
    auto options = std::make_shared<DiffOptions>();
    CLI::App* diff = image.add_subcommand("diff", "how far a picture is from a reference");
    diff->add_option("a", options->a, "picture")->required();
    diff->add_option("b", options->b, "reference of the same size")->required();
    diff->add_option("--fail-above", options->fail_above,
                     "exit with 1 if the RMSE of any layer is above this, or a channel is missing")
        ->transform(number_between(0, std::numeric_limits<float>::max()));
    add_field_option(*diff, options->order, "max-memory");
    diff->footer(fmt::format(
        "symmetric MSE is the mean of (a - b)^2 / ((a^2 + b^2) / 2 + f^2), where f is {} times the "
        "reference's mid-grey: 0 for equal pictures, {:g} at most, and the same for light that is "
        "lost and light that is added. It is for light: the layers RGB, Y and denoised of an .exr. "
        "relative MSE is the mean of (a - b)^2 / (b^2 + {}); the peak of PSNR is the largest value "
        "of b.",
        io::kSymmetricFloorShare, io::kMostSymmetricMse, io::kRelativeMseEpsilon));
    diff->callback([options] { diff_command(*options); });
}

struct SpectrumOptions {
    std::string in, pixel, plot;
    RenderOrder order;
};

void spectrum_command(const SpectrumOptions& o) {
    const V2i at = parse_pixel("pixel", o.pixel);
    if (!o.plot.empty()) {
        io::refuse_overwriting({{"-o", o.plot}}, {{"the picture to read", o.in}});
        io::check_plot(o.plot);
    }
    io::PictureBudget pictures = o.order.render.scene.pictures();
    const auto [spectrum, denoised] =
        io::spectra_of_pixel(io::read_picture(o.in, pictures), o.in, at.x, at.y);
    if (!o.plot.empty()) {
        io::Plot plot{.title = fmt::format("pixel {},{} of {}", at.x, at.y, o.in),
                      .x_label = "wavelength (nm)",
                      .y_label = "spectral radiance (W m⁻² sr⁻¹ nm⁻¹)",
                      .series = {{spectrum, io::PlotStyle::Steps, ""}}};
        if (!denoised.empty()) {
            plot.series.front().label = "picture";
            plot.series.push_back({denoised, io::PlotStyle::Steps, "denoised"});
        }
        io::write_plot(o.plot, plot);
    }
    for (const auto& [nm, value] : spectrum) {
        fmt::print("{:.7g} {:.9g}", nm, value);
        for (const auto& [denoised_nm, denoised_value] : denoised)
            if (denoised_nm == nm) fmt::print(" {:.9g}", denoised_value);
        fmt::print("\n");
    }
}

void add_spectrum(CLI::App& image) {
    auto options = std::make_shared<SpectrumOptions>();
    CLI::App* spectrum =
        image.add_subcommand("spectrum",
                             "print one pixel of a spectral picture: nm, value, and the denoised "
                             "value where it has one");
    spectrum->add_option("picture", options->in, "spectral .exr, as render --bins writes")
        ->required();
    spectrum->add_option("pixel", options->pixel, "x,y in pixels of the full frame")->required();
    spectrum->add_option("-o,--output", options->plot, "plot to write too, .svg or .png");
    add_field_option(*spectrum, options->order, "max-memory");
    spectrum->callback([options] { spectrum_command(*options); });
}

}  // namespace

void add_image_commands(CLI::App& app) {
    CLI::App* image = app.add_subcommand("image", "compare and show pictures");
    image->require_subcommand(1);
    add_diff(*image);
    add_view(*image);
    add_noise(*image);
    add_spectrum(*image);
}

}  // namespace petzval::apps
