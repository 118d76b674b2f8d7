// SPDX-License-Identifier: Apache-2.0
#include "io/image/environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "io/base/error.h"
#include "io/image/picture_files.h"

namespace petzval::io {
namespace {

std::array<int, 3> colour_channels(const Picture& picture, const std::filesystem::path& path) {
    if (const int grey = channel_index(picture, "Y"); grey >= 0) return {grey, grey, grey};
    const std::array<int, 3> rgb{channel_index(picture, "R"), channel_index(picture, "G"),
                                 channel_index(picture, "B")};
    if (rgb[0] < 0 || rgb[1] < 0 || rgb[2] < 0)
        throw InputError(path.string(), "", "an environment needs channels R, G and B (or Y)");
    return rgb;
}

/// Values of a sky that cannot be light, counted.
struct Mended {
    uint64_t negative = 0, infinite = 0, not_numbers = 0;
};

/// Sky texels of a picture. Values below 0 and those that are no number become 0. Infinite ones,
/// which a sun is in files of 16 bits, become the greatest that is finite.
std::vector<float> sky_texels(const Picture& picture, const std::filesystem::path& path,
                              Mended& mended) {
    const std::array<int, 3> from = colour_channels(picture, path);
    std::vector<float> rgb;
    rgb.reserve(size_t(picture.width) * picture.height * 3);
    float greatest = 0.f;
    for (size_t i = 0; i < picture.pixels.size(); i += picture.channels.size())
        for (const int channel : from) {
            const float value = picture.pixels[i + channel];
            mended.not_numbers += std::isnan(value);
            mended.negative += value < 0.f;
            rgb.push_back(value > 0.f ? value : 0.f);
            if (std::isfinite(value)) greatest = std::max(greatest, value);
        }
    for (float& value : rgb) {
        if (!std::isinf(value)) continue;
        value = greatest;
        ++mended.infinite;
    }
    return rgb;
}

void report(const Mended& mended, const std::string& file, const Notice& notice) {
    const auto say = [&](uint64_t count, const char* what) {
        if (count > 0) notice(fmt::format("warning: {}: {} {}", file, count, what));
    };
    say(mended.negative, "negative values read as 0");
    say(mended.not_numbers, "values that are no number read as 0");
    say(mended.infinite, "infinite values read as the greatest finite one");
}

void check_kind(const std::filesystem::path& path) {
    const std::string ending = path.extension().string();
    for (const char* known : {".hdr", ".exr", ".HDR", ".EXR"})
        if (ending == known) return;
    throw InputError(path.string(), "",
                     "an environment must be a Radiance .hdr or an OpenEXR .exr picture");
}

Sky decode(const std::filesystem::path& path, float rotate_deg, float strength,
           const Notice& notice, PictureBudget& budget) {
    check_kind(path);
    constexpr uint64_t sky_bytes_per_texel = 28;  // the most while Sky::picture works
    Picture picture = read_picture(path, budget, sky_bytes_per_texel);
    if (picture.width != picture.full_width || picture.height != picture.full_height)
        throw InputError(path.string(), "",
                         "holds {}x{} of {}x{} pixels; an environment must be whole", picture.width,
                         picture.height, picture.full_width, picture.full_height);
    Mended mended;
    std::vector<float> rgb = sky_texels(picture, path, mended);
    picture.pixels = std::vector<float>();   // "= {}" would keep its memory
    constexpr float brightest_nits = 1e20f;  // sums over the sky and the scene stay finite
    if (!rgb.empty() && *std::max_element(rgb.begin(), rgb.end()) * strength > brightest_nits)
        throw InputError(path.string(), "",
                         "brighter than {:g} nits once it is multiplied by {:g}; give a "
                         "smaller ⟨env-strength⟩",
                         brightest_nits, strength);
    report(mended, path.string(), notice);
    if (picture.width != 2 * picture.height)
        notice(fmt::format(
            "warning: {}: {}x{} pixels are not 2:1; the picture is stretched over the sphere",
            path.string(), picture.width, picture.height));
    return Sky::picture(std::move(rgb), picture.width, picture.height, rotate_deg, strength);
}

}  // namespace

Sky load_sky(const std::filesystem::path& path, float rotate_deg, float strength,
             const Notice& notice, PictureBudget& budget) {
    return naming_file(path.string(),
                       [&] { return decode(path, rotate_deg, strength, notice, budget); });
}

}  // namespace petzval::io
