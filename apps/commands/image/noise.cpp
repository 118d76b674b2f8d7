// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/image/noise.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "apps/cli/console.h"
#include "apps/cli/field_options.h"
#include "apps/cli/readers.h"
#include "core/spectrum/bands.h"
#include "io/base/error.h"
#include "io/base/format.h"
#include "io/image/picture_files.h"
#include "io/image/symmetric_mse.h"

namespace petzval::apps {
namespace {

struct NoiseOptions {
    std::string in;
    int regions = 4;
    RenderOrder order;
};

/// Channels of a picture that states its errors.
struct StatedErrors {
    const io::Picture& picture;
    std::array<int, 3> colour{}, error{};
    int samples = -1;

    [[nodiscard]] double at(int x, int y, int channel) const {
        const auto pixel =
            static_cast<size_t>(y) * static_cast<size_t>(picture.width) + static_cast<size_t>(x);
        return double(
            picture.pixels[pixel * picture.channels.size() + static_cast<size_t>(channel)]);
    }
    [[nodiscard]] double floor() const {
        io::SymmetricFloor out;
        for (int y = 0; y < picture.height; ++y)
            for (int x = 0; x < picture.width; ++x)
                out.add(double(luminance({float(at(x, y, colour[0])), float(at(x, y, colour[1])),
                                          float(at(x, y, colour[2]))})));
        return out.floor();
    }
};

StatedErrors stated_errors(const io::Picture& picture, const std::string& file) {
    StatedErrors out{picture};
    for (size_t c = 0; c < 3; ++c) {
        const char* const names[] = {"R", "G", "B"};
        out.colour[c] = io::channel_index(picture, names[c]);
        out.error[c] = io::channel_index(picture, std::string("stderr.") + names[c]);
        if (out.colour[c] < 0 || out.error[c] < 0)
            throw io::InputError(file, "",
                                 "states no errors: render it with ⟨noise⟩ or ⟨bins⟩, as .exr");
    }
    out.samples = io::channel_index(picture, "samples.N");
    return out;
}

void noise_command(const NoiseOptions& o) {
    io::PictureBudget pictures = o.order.render.scene.pictures();
    const io::Picture picture = io::read_picture(o.in, pictures);
    const StatedErrors stated = stated_errors(picture, o.in);
    const double floor2 = std::pow(stated.floor(), 2);
    const int across = std::min(o.regions, picture.width),
              down = std::min(o.regions, picture.height);
    const auto line = [&](const std::string& name, int x0, int y0, int x1, int y1) {
        double squares = 0, samples = 0;
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) {
                for (size_t c = 0; c < 3; ++c) {
                    const double mean = stated.at(x, y, stated.colour[c]),
                                 error = stated.at(x, y, stated.error[c]),
                                 scale = mean * mean + floor2;
                    if (scale > 0) squares += error * error / scale / 3;
                }
                if (stated.samples >= 0) samples += stated.at(x, y, stated.samples);
            }
        const double pixels = double(x1 - x0) * double(y1 - y0);
        std::string text =
            fmt::format("{:<24} noise {:>7}", name, io::percent(std::sqrt(squares / pixels)));
        if (stated.samples >= 0) text += fmt::format("  samples {:.0f}", samples / pixels);
        print_line(text);
    };
    line("picture", 0, 0, picture.width, picture.height);
    for (int j = 0; j < down; ++j)
        for (int i = 0; i < across; ++i) {
            const int x0 = picture.width * i / across, x1 = picture.width * (i + 1) / across,
                      y0 = picture.height * j / down, y1 = picture.height * (j + 1) / down;
            line(fmt::format("{},{},{},{}", picture.x + x0, picture.y + y0, x1 - x0, y1 - y0), x0,
                 y0, x1, y1);
        }
}

}  // namespace

void add_noise(CLI::App& image) {
    auto options = std::make_shared<NoiseOptions>();
    CLI::App* noise =
        image.add_subcommand("noise", "print the noise that a picture states of itself, by region");
    noise->add_option("picture", options->in, ".exr, as render --noise or --bins writes")
        ->required();
    noise->add_option("--regions", options->regions, "so many along each side (default 4)")
        ->transform(number_between(1, 1000));
    add_field_option(*noise, options->order, "max-memory");
    noise->footer(
        "A region is x,y,width,height of the full frame. Its noise is the root of the mean, over "
        "its pixels and R, G and B, of stderr^2 / (mean^2 + f^2); f is that of petzval image "
        "diff.");
    noise->callback([options] { noise_command(*options); });
}

}  // namespace petzval::apps
