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
#include "io/base/printable.h"
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

/// Calls f(region) for all of width x height, then for the cells of a grid over it.
template <class F>
void for_each_region(int width, int height, int regions, const F& f) {
    f(Rect{0, 0, width, height});
    const int across = std::min(regions, width), down = std::min(regions, height);
    if (across * down == 1) return;
    for (int j = 0; j < down; ++j)
        for (int i = 0; i < across; ++i)
            f(Rect{width * i / across, height * j / down, width * (i + 1) / across,
                   height * (j + 1) / down});
}

/// Name of a part of a picture: "picture", or x,y,width,height of the full frame.
std::string region_name(const Rect& part, const Rect& picture) {
    if (part == picture) return "picture";
    return fmt::format("{},{},{},{}", part.x0, part.y0, part.width(), part.height());
}

void require_halves(const std::string& file, const MergedState& state) {
    const Film& film = state.film;
    const bool tells_in_picture = film.keeps().blocks || film.spectral();
    if (!film.keeps().halves && tells_in_picture)
        throw io::InputError(file, "",
                             "tells its noise as a picture: petzval merge {0} -o picture.exr, then "
                             "petzval image noise picture.exr",
                             io::for_shell(file));
    if (!film.keeps().halves)
        throw io::InputError(file, "", "tells no error by region: render it with ⟨denoise⟩");
    if (film.taken_range().least < 2)
        throw io::InputError(file, "",
                             "one of the two halves has no samples; merge it with states of other "
                             "ranges first");
}

void state_noise(const NoiseOptions& o) {
    if (o.order.render.scene.picture_memory_bytes)
        throw io::ArgumentError(o.in, "", "⟨max-memory⟩ is for pictures");
    const MergedState state = merge_states({o.in});
    require_halves(o.in, state);
    integrator::TbbExecutor executor(threads_of(RunRequest{}));
    const auto denoised = denoised_film(state.film, executor, false);
    const ErrorBlocks& blocks = denoised->blocks;
    const Rect crop = state.film.crop();
    for_each_region(blocks.across(), blocks.down(), o.regions, [&](const Rect& r) {
        const Rect part{crop.x0 + r.x0 * kErrorBlock_px, crop.y0 + r.y0 * kErrorBlock_px,
                        std::min(crop.x0 + r.x1 * kErrorBlock_px, crop.x1),
                        std::min(crop.y0 + r.y1 * kErrorBlock_px, crop.y1)};
        print_line(fmt::format("{:<24} denoised {:<26} without {}", region_name(part, crop),
                               text_of(blocks.over(r)), text_of(denoised->noisy_blocks.over(r))));
    });
}

void noise_command(const NoiseOptions& o) {
    if (is_state_name(o.in)) return state_noise(o);
    io::PictureBudget pictures = o.order.render.scene.pictures();
    const io::Picture picture = io::read_picture(o.in, pictures);
    const StatedErrors stated = stated_errors(picture, o.in);
    const double floor2 = std::pow(stated.floor(), 2);
    const auto in_frame = [&](const Rect& r) {
        return Rect{picture.x + r.x0, picture.y + r.y0, picture.x + r.x1, picture.y + r.y1};
    };
    const Rect whole = in_frame({0, 0, picture.width, picture.height});
    for_each_region(picture.width, picture.height, o.regions, [&](const Rect& part) {
        double squares = 0, samples = 0;
        for (int y = part.y0; y < part.y1; ++y)
            for (int x = part.x0; x < part.x1; ++x) {
                for (size_t c = 0; c < 3; ++c) {
                    const double mean = stated.at(x, y, stated.colour[c]),
                                 error = stated.at(x, y, stated.error[c]),
                                 scale = mean * mean + floor2;
                    if (scale > 0) squares += error * error / scale / 3;
                }
                if (stated.samples >= 0) samples += stated.at(x, y, stated.samples);
            }
        const double pixels = double(part.width()) * double(part.height());
        std::string text = fmt::format("{:<24} noise {:>7}", region_name(in_frame(part), whole),
                                       io::percent(std::sqrt(squares / pixels)));
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
        "its pixels and R, G and B, of stderr^2 / (mean^2 + f^2); f is that of petzval image diff. "
        "Of a state it is the error of the denoised picture, and of the picture without denoising, "
        "over blocks of 8 x 8 pixels, with bounds that hold it with a chance of 95 %; mean is that "
        "of the denoised picture over 7 x 7 pixels. Regions of few blocks tell \"at most\" alone.");
    noise->callback([options] { noise_command(*options); });
}

}  // namespace petzval::apps
