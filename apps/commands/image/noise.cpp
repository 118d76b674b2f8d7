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
#include "apps/request/file_names.h"
#include "apps/setup/denoised_film.h"
#include "apps/state/merge.h"
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

/// Calls f(name, rectangle) for the whole picture, then for its regions.
template <class F>
void for_each_region(const Rect& whole, int regions, const F& f) {
    f("picture", whole);
    const int width = whole.width(), height = whole.height();
    const int across = std::min(regions, width), down = std::min(regions, height);
    for (int j = 0; j < down; ++j)
        for (int i = 0; i < across; ++i) {
            const Rect r{whole.x0 + width * i / across, whole.y0 + height * j / down,
                         whole.x0 + width * (i + 1) / across, whole.y0 + height * (j + 1) / down};
            f(fmt::format("{},{},{},{}", r.x0, r.y0, r.width(), r.height()), r);
        }
}

void state_noise(const NoiseOptions& o) {
    const MergedState state = merge_states({o.in});
    if (!state.film.keeps().halves)
        throw io::InputError(o.in, "", "tells no error by region: render it with ⟨denoise⟩");
    integrator::TbbExecutor executor(threads_of(RunRequest{}));
    const auto denoised = denoised_film(state.film, executor, false);
    for_each_region(state.film.crop(), o.regions, [&](const std::string& name, const Rect& part) {
        const Rect blocks = denoised->blocks_of(part);
        print_line(fmt::format("{:<24} denoised {:<26} without {}", name,
                               text_of(denoised->blocks.over(blocks)),
                               text_of(denoised->noisy_blocks.over(blocks))));
    });
}

void noise_command(const NoiseOptions& o) {
    if (is_state_name(o.in)) return state_noise(o);
    io::PictureBudget pictures = o.order.render.scene.pictures();
    const io::Picture picture = io::read_picture(o.in, pictures);
    const StatedErrors stated = stated_errors(picture, o.in);
    const double floor2 = std::pow(stated.floor(), 2);
    const Rect whole{picture.x, picture.y, picture.x + picture.width, picture.y + picture.height};
    for_each_region(whole, o.regions, [&](const std::string& name, const Rect& part) {
        double squares = 0, samples = 0;
        for (int y = part.y0 - whole.y0; y < part.y1 - whole.y0; ++y)
            for (int x = part.x0 - whole.x0; x < part.x1 - whole.x0; ++x) {
                for (size_t c = 0; c < 3; ++c) {
                    const double mean = stated.at(x, y, stated.colour[c]),
                                 error = stated.at(x, y, stated.error[c]),
                                 scale = mean * mean + floor2;
                    if (scale > 0) squares += error * error / scale / 3;
                }
                if (stated.samples >= 0) samples += stated.at(x, y, stated.samples);
            }
        const double pixels = double(part.width()) * double(part.height());
        std::string text =
            fmt::format("{:<24} noise {:>7}", name, io::percent(std::sqrt(squares / pixels)));
        if (stated.samples >= 0) text += fmt::format("  samples {:.0f}", samples / pixels);
        print_line(text);
    });
}

}  // namespace

void add_noise(CLI::App& image) {
    auto options = std::make_shared<NoiseOptions>();
    CLI::App* noise =
        image.add_subcommand("noise", "print the noise that a picture states of itself, by region");
    noise
        ->add_option("picture", options->in,
                     ".exr of render --noise or --bins, or .state of render --denoise")
        ->required();
    noise->add_option("--regions", options->regions, "so many along each side (default 4)")
        ->transform(number_between(1, 1000));
    add_field_option(*noise, options->order, "max-memory");
    noise->footer(
        "A region is x,y,width,height of the full frame. Its noise is the root of the mean, over "
        "its pixels and R, G and B, of stderr^2 / (mean^2 + f^2); f is that of petzval image "
        "diff. Of a state it is the error of the denoised picture and of the other one, with "
        "bounds "
        "that hold it with a chance of 95 %, over the blocks of 8 x 8 pixels that fill the region "
        "best.");
    noise->callback([options] { noise_command(*options); });
}

}  // namespace petzval::apps
