// SPDX-License-Identifier: Apache-2.0
#include "io/image/display.h"

#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "io/base/assets.h"
#include "io/base/error.h"
#include "io/image/oiio_message.h"

namespace petzval {
namespace {

namespace ocio = OCIO_NAMESPACE;

struct Config {
    std::string path;
    ocio::ConstConfigRcPtr config;
    [[nodiscard]] const char* display() const { return config->getDefaultDisplay(); }
};

InputError config_error(const std::string& path, const ocio::Exception& error) {
    return {path, "", "cannot be used: " + first_line(error.what())};
}

Config load_config() {
    const std::string path = asset("color/config.ocio").string();
    try {
        return {path, ocio::Config::CreateFromFile(path.c_str())};
    } catch (const ocio::Exception& error) {
        throw config_error(path, error);
    }
}

std::vector<std::string> views_of(const Config& loaded) {
    std::vector<std::string> views;
    for (int i = 0; i < loaded.config->getNumViews(loaded.display()); ++i)
        views.emplace_back(loaded.config->getView(loaded.display(), i));
    return views;
}

/// Colour config, which must have that view.
Config load_config_with(const std::string& view) {
    Config loaded = load_config();
    const std::vector<std::string> views = views_of(loaded);
    if (std::find(views.begin(), views.end(), view) == views.end())
        throw InputError(
            loaded.path, "",
            fmt::format("there is no view \"{}\"; there are {}", view, fmt::join(views, ", ")));
    return loaded;
}

/// Processor that applies a view to pixels. Lossless: OpenColorIO's fast powers are off by more
/// than a 16-bit step.
ocio::ConstCPUProcessorRcPtr view_processor(const std::string& view) {
    const Config loaded = load_config_with(view);
    try {
        return loaded.config
            ->getProcessor(ocio::ROLE_SCENE_LINEAR, loaded.display(), view.c_str(),
                           ocio::TRANSFORM_DIR_FORWARD)
            ->getOptimizedCPUProcessor(ocio::OPTIMIZATION_LOSSLESS);
    } catch (const ocio::Exception& error) {
        throw config_error(loaded.path, error);
    }
}

/// Indices of R, G and B among the channels.
std::array<int, 3> colour_channels(const PictureLayout& picture) {
    if (const int grey = channel_index(picture, "Y"); grey >= 0) return {grey, grey, grey};
    return {channel_index(picture, "R"), channel_index(picture, "G"), channel_index(picture, "B")};
}

}  // namespace

std::vector<std::string> display_views() {
    return views_of(load_config());
}

void check_view(const std::string& view) {
    static_cast<void>(load_config_with(view));
}

PictureRows to_display(const PictureRows& linear, float exposure_ev, const std::string& view,
                       AlphaUse alpha_use) {
    const std::array<int, 3> from = colour_channels(linear.layout);
    if (*std::min_element(from.begin(), from.end()) < 0)
        throw InputError("the picture", "", "has no channels R, G and B (nor Y) to show");
    const int alpha_from = alpha_use == AlphaUse::Keep ? channel_index(linear.layout, "A") : -1;

    PictureLayout layout = linear.layout;
    layout.channels = {"R", "G", "B"};
    if (alpha_from >= 0) layout.channels.emplace_back("A");
    const size_t width = size_t(layout.width), channels = linear.layout.channels.size();
    const long shown_channels = long(layout.channels.size());
    const float scale = std::exp2(exposure_ev);
    const auto row = [=, source = linear.row, processor = view_processor(view),
                      values = std::vector<float>(width * channels)](int y, float* out) mutable {
        source(y, values.data());
        ocio::PackedImageDesc shown(out, long(width), 1, shown_channels);
        for (size_t i = 0; i < values.size(); i += channels) {
            const float* pixel = &values[i];
            const float alpha = alpha_from < 0 ? 1.f : pixel[alpha_from];
            for (const int channel : from)
                *out++ = alpha > 0.f ? pixel[channel] * scale / alpha : 0.f;
            if (alpha_from >= 0) *out++ = alpha;
        }
        processor->apply(shown);
    };
    return {std::move(layout), row};
}

}  // namespace petzval
