// SPDX-License-Identifier: Apache-2.0
#include "io/image/difference.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

#include "core/spectrum/bands.h"
#include "io/base/error.h"
#include "io/image/picture_files.h"
#include "io/image/spectral_layout.h"
#include "io/image/symmetric_mse.h"

namespace petzval::io {
namespace {

std::string layer_of(const std::string& channel) {
    if (channel == "R" || channel == "G" || channel == "B") return "RGB";
    if (channel.ends_with(".error")) return channel;  // of the layer, not a part of it
    const size_t point = channel.rfind('.');
    return point == std::string::npos ? channel : channel.substr(0, point);
}

/// Whether a layer is the light that luminances are made of.
bool is_light(const std::string& layer) {
    return layer == "RGB" || layer == "Y" || layer == "denoised";
}

/// Sums over the values of one layer.
struct Sums {
    LayerDifference found;
    std::optional<double> floor;  ///< of the symmetric MSE, where the layer has one
    double symmetric = 0., squares = 0., relative = 0.;

    void add(double a, double b, int x, int y, const std::string& channel) {
        if (!std::isfinite(a) || !std::isfinite(b)) {
            ++found.not_finite;
            return;
        }
        const double difference = std::fabs(a - b);
        ++found.value_count;
        if (floor) symmetric += symmetric_square(a, b, *floor);
        squares += difference * difference;
        relative += difference * difference / (b * b + kRelativeMseEpsilon);
        found.peak = std::max(found.peak, std::fabs(b));
        if (difference <= found.max_abs) return;
        found.max_abs = difference;
        found.max_channel = channel;
        found.max_x = x;
        found.max_y = y;
    }

    [[nodiscard]] LayerDifference result() && {
        const double count = std::max<double>(1., static_cast<double>(found.value_count));
        if (floor) found.symmetric_mse = symmetric / count;
        found.rmse = std::sqrt(squares / count);
        found.relative_mse = relative / count;
        found.psnr_db = found.rmse > 0. ? 20. * std::log10(found.peak / found.rmse)
                                        : std::numeric_limits<double>::infinity();
        return std::move(found);
    }
};

Sums& sums_of(std::vector<Sums>& layers, const std::string& name, std::optional<double> floor) {
    for (Sums& layer : layers)
        if (layer.found.layer == name) return layer;
    Sums& layer = layers.emplace_back();
    layer.found.layer = name;
    if (is_light(name)) layer.floor = floor;
    return layer;
}

std::vector<std::string> sorted(std::vector<std::string> names) {
    std::sort(names.begin(), names.end());
    return names;
}

std::string frame(const Picture& p) {
    return fmt::format("{}x{} pixels from {},{} of {}x{}", p.width, p.height, p.x, p.y,
                       p.full_width, p.full_height);
}

std::string why_not_the_same_wavelengths(const Picture& a, const Picture& b) {
    const auto in_a = spectral_channels(a), in_b = spectral_channels(b);
    if (in_a.empty() != in_b.empty())
        return fmt::format("the {} is spectral, the {} is not", in_a.empty() ? "latter" : "former",
                           in_a.empty() ? "former" : "latter");
    for (size_t i = 0; i < std::min(in_a.size(), in_b.size()); ++i)
        if (in_a[i].nm != in_b[i].nm)
            return fmt::format("wavelength {} is {:.7g} nm against {:.7g} nm", i + 1, in_a[i].nm,
                               in_b[i].nm);
    if (in_a.size() != in_b.size())
        return fmt::format("{} wavelengths, up to {:.7g} nm, against {}, up to {:.7g} nm",
                           in_a.size(), in_a.back().nm, in_b.size(), in_b.back().nm);
    return "";
}

}  // namespace

std::optional<double> floor_against(const Picture& reference) {
    const int grey = channel_index(reference, "Y");
    const auto from = [&](const char* name) { return channel_index(reference, name); };
    std::array<int, 3> at{from("R"), from("G"), from("B")};
    if (*std::min_element(at.begin(), at.end()) < 0) at = {grey, grey, grey};
    if (at[0] < 0 || reference.for_display) return std::nullopt;
    SymmetricFloor floor;
    for (size_t i = 0; i < reference.pixels.size(); i += reference.channels.size()) {
        const auto value = [&](int c) { return reference.pixels[i + static_cast<size_t>(c)]; };
        floor.add(double(luminance(Rgb(value(at[0]), value(at[1]), value(at[2])))));
    }
    return floor.floor();
}

std::string why_not_comparable(const Picture& a, const Picture& b) {
    if (frame(a) != frame(b)) return fmt::format("{} against {}", frame(a), frame(b));
    if (a.for_display != b.for_display)
        return fmt::format(
            "the {0} holds values for a display, the {1} light; make a picture for a display of "
            "the {1} too, by petzval image view",
            a.for_display ? "former" : "latter", a.for_display ? "latter" : "former");
    std::string why = why_not_the_same_wavelengths(a, b);
    if (!why.empty()) return why;
    const auto is_in_a = [&](const std::string& name) { return channel_index(a, name) >= 0; };
    if (std::ranges::none_of(b.channels, is_in_a))
        return "no channel is in both: " + channels_of_one(a, b);
    return "";
}

std::string channels_of_one(const Picture& a, const Picture& b) {
    const auto in_a = sorted(a.channels), in_b = sorted(b.channels);
    if (in_a == in_b) return "";
    std::vector<std::string> texts;
    const auto add = [&](const char* which, const auto& one, const auto& other) {
        std::vector<std::string> rest;
        std::ranges::set_difference(one, other, std::back_inserter(rest));
        if (!rest.empty())
            texts.push_back(fmt::format("only in the {}: {}", which, fmt::join(rest, " ")));
    };
    add("former", in_a, in_b);
    add("latter", in_b, in_a);
    return fmt::format("channels {}", fmt::join(texts, "; "));
}

std::vector<LayerDifference> compare(const Picture& a, const Picture& b) {
    const std::optional<double> floor = floor_against(b);
    std::vector<Sums> layers;
    // A channel of a layer that the other picture has in part is told by its own name.
    std::set<std::string> parted;
    for (const auto* const of : {&a, &b})
        for (const std::string& channel : of->channels)
            if (channel_index(of == &a ? b : a, channel) < 0) parted.insert(layer_of(channel));
    for (size_t c = 0; c < b.channels.size(); ++c) {
        const int its_index = channel_index(a, b.channels[c]);
        if (its_index < 0) continue;
        const auto in_a = static_cast<size_t>(its_index);
        const std::string layer = layer_of(b.channels[c]);
        Sums& sums = sums_of(layers, parted.contains(layer) ? b.channels[c] : layer, floor);
        for (int y = 0; y < b.height; ++y)
            for (int x = 0; x < b.width; ++x) {
                const size_t pixel = size_t(y) * b.width + x;
                sums.add(a.pixels[pixel * a.channels.size() + in_a],
                         b.pixels[pixel * b.channels.size() + c], b.x + x, b.y + y, b.channels[c]);
            }
    }
    std::vector<LayerDifference> results;
    for (Sums& sums : layers) results.push_back(std::move(sums).result());
    return results;
}

FileDifferences compare_files(const std::filesystem::path& a, const std::filesystem::path& b,
                              PictureBudget budget) {
    const Picture picture_a = read_picture(a, budget);
    const Picture picture_b = read_picture(b, budget);
    const std::string why = why_not_comparable(picture_a, picture_b);
    if (!why.empty())
        throw InputError(a.string(), "", "differs in kind from {}: {}", b.string(), why);
    return {compare(picture_a, picture_b), channels_of_one(picture_a, picture_b)};
}

}  // namespace petzval::io
