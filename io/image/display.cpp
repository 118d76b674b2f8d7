// SPDX-License-Identifier: Apache-2.0
#include "io/image/display.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "io/base/ascii.h"
#include "io/base/error.h"
#include "io/base/nearest.h"
#include "io/file/assets.h"
#include "io/file/text_lines.h"
#include "io/image/ocio_config.h"

namespace petzval::io {
namespace {

namespace ocio = OCIO_NAMESPACE;

struct Config {
    std::string path;
    ocio::ConstConfigRcPtr config;
    bool own = false;
};

InputError config_error(const std::string& path, const ocio::Exception& error) {
    return {path, "", "cannot be used: " + first_line(error.what())};
}

Config load_config(const std::filesystem::path& file) {
    const std::string path = file.empty() ? asset("color/config.ocio").string() : file.string();
    return {path, open_ocio_config(path).config, file.empty()};
}

/// View of a display, and its name among those of all displays.
struct View {
    std::string display, view, name;
};

/// Views of Petzval's configuration. OpenColorIO's other functions would leave out what the
/// variable OCIO_ACTIVE_VIEWS does not name, which is about a studio's configuration.
std::vector<View> own_views(const ocio::Config& config) {
    const char* const display = config.getDisplayAll(0);
    std::vector<View> views;
    for (int i = 0; i < config.getNumViews(ocio::VIEW_DISPLAY_DEFINED, display); ++i) {
        const std::string view = config.getView(ocio::VIEW_DISPLAY_DEFINED, display, i);
        views.push_back({display, view, view});
    }
    return views;
}

/// Views of all displays, the default one first.
std::vector<View> views_of(const Config& loaded) {
    if (loaded.own) return own_views(*loaded.config);
    const std::string first = loaded.config->getDefaultDisplay();
    std::vector<std::string> displays{first};
    for (int i = 0; i < loaded.config->getNumDisplays(); ++i)
        if (const std::string other = loaded.config->getDisplay(i); other != first)
            displays.push_back(other);
    std::vector<View> views;
    for (const std::string& display : displays) {
        const std::string usual = loaded.config->getDefaultView(display.c_str());
        const size_t begin = views.size();
        for (int i = 0; i < loaded.config->getNumViews(display.c_str()); ++i) {
            const std::string view = loaded.config->getView(display.c_str(), i);
            const auto at = view == usual ? views.begin() + std::ptrdiff_t(begin) : views.end();
            views.insert(at, View{display, view, display == first ? view : display + "/" + view});
        }
    }
    return views;
}

std::vector<std::string> names_of(const std::vector<View>& views) {
    std::vector<std::string> names;
    for (const View& view : views) names.push_back(view.name);
    return names;
}

/// View that a text means.
View view_of(const Config& loaded, const std::string& text) {
    const std::vector<View> views = views_of(loaded);
    if (views.empty()) throw InputError(loaded.path, "", "has no display with a view");
    if (text.empty()) return views.front();
    const std::string wanted = lower(text);
    for (const View& view : views)
        if (view.name == text) return view;
    for (const View& view : views)
        if (wanted == lower(view.name) || wanted == lower(view.view) ||
            wanted == lower(view.display + "/" + view.view))
            return view;
    const std::vector<std::string> names = names_of(views);
    throw InputError(loaded.own ? "Petzval's configuration" : loaded.path, "",
                     "there is no view \"{}\"; there are {}{}", text, fmt::join(names, ", "),
                     did_you_mean(text, names));
}

/// Names by which configurations call the linear space of Rec. 709 with a D65 white: those of the
/// Color Interop Forum, of the ACES configurations from version 1 to 4, and of Blender's.
constexpr std::array<const char*, 8> kLinearRec709{"lin_rec709_scene",
                                                   "lin_rec709",
                                                   "lin_rec709_srgb",
                                                   "lin_srgb",
                                                   "Linear Rec.709 (sRGB)",
                                                   "Linear Rec.709",
                                                   "Utility - Linear - Rec.709",
                                                   "Utility - Linear - sRGB"};
/// Role of ACES2065-1 in a configuration.
constexpr const char* kAces = "aces_interchange";

/// Whether a view shows numbers as they are.
bool shows_data(const Config& loaded, const View& view) {
    const auto space = loaded.config->getColorSpace(
        loaded.config->getDisplayViewColorSpaceName(view.display.c_str(), view.view.c_str()));
    return space && space->isData();
}

/// Transform of linear Rec. 709 by a view. A configuration that has no such space is entered
/// through ACES2065-1, if it says which of its spaces that is.
ocio::ConstTransformRcPtr transform_of(const Config& loaded, const View& view) {
    auto shown = ocio::DisplayViewTransform::Create();
    shown->setDisplay(view.display.c_str());
    shown->setView(view.view.c_str());
    for (const char* name : kLinearRec709) {
        if (!loaded.config->getColorSpace(name)) continue;
        shown->setSrc(name);
        return shown;
    }
    if (!loaded.config->hasRole(kAces))
        throw InputError(loaded.path, "",
                         "does not say which of its colour spaces is linear Rec. 709, "
                         "in which pictures are rendered; give one the alias or role "
                         "{}, or ACES2065-1 the role {}",
                         kLinearRec709[1], kAces);
    shown->setSrc(kAces);
    if (shows_data(loaded, view)) return shown;
    auto all = ocio::GroupTransform::Create();
    for (const auto& [style, direction] :
         {std::pair("UTILITY - ACES-AP1_to_LINEAR-REC709_BFD", ocio::TRANSFORM_DIR_INVERSE),
          std::pair("ACEScg_to_ACES2065-1", ocio::TRANSFORM_DIR_FORWARD)}) {
        auto step = ocio::BuiltinTransform::Create();
        step->setStyle(style);
        step->setDirection(direction);
        all->appendTransform(step);
    }
    all->appendTransform(shown);
    return all;
}

/// Processor that applies a view to pixels. Lossless: OpenColorIO's fast powers are off by more
/// than a 16-bit step.
ocio::ConstCPUProcessorRcPtr view_processor(const Config& loaded, const View& view) {
    try {
        return loaded.config->getProcessor(transform_of(loaded, view))
            ->getOptimizedCPUProcessor(ocio::OPTIMIZATION_LOSSLESS);
    } catch (const ocio::Exception& error) {
        throw config_error(loaded.path, error);
    }
}

/// Indices of R, G and B among the channels. Throws where there are none.
std::array<int, 3> colour_channels(const PictureLayout& picture) {
    if (const int grey = channel_index(picture, "Y"); grey >= 0) return {grey, grey, grey};
    const std::array<int, 3> rgb{channel_index(picture, "R"), channel_index(picture, "G"),
                                 channel_index(picture, "B")};
    if (*std::min_element(rgb.begin(), rgb.end()) < 0)
        throw InputError("the picture", "", "has no channels R, G and B (nor Y) to show");
    return rgb;
}

}  // namespace

std::vector<std::string> display_views(const std::filesystem::path& config) {
    return names_of(views_of(load_config(config)));
}

std::string find_view(const std::string& text, const std::filesystem::path& config) {
    const Config loaded = load_config(config);
    View view = view_of(loaded, text);
    static_cast<void>(view_processor(loaded, view));
    return std::move(view.name);
}

PictureRows to_display(const PictureRows& linear, float exposure_ev, const std::string& view,
                       AlphaUse alpha_use, const std::filesystem::path& config) {
    const std::array<int, 3> from = colour_channels(linear.layout);
    const int alpha_from = alpha_use == AlphaUse::Keep ? channel_index(linear.layout, "A") : -1;

    PictureLayout layout = linear.layout;
    layout.channels = {"R", "G", "B"};
    if (alpha_from >= 0) layout.channels.emplace_back("A");
    const size_t width = size_t(layout.width), channels = linear.layout.channels.size();
    const long shown_channels = long(layout.channels.size());
    const float scale = std::exp2(exposure_ev);
    const Config loaded = load_config(config);
    const auto row = [=, source = linear.row,
                      processor = view_processor(loaded, view_of(loaded, view)),
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

PictureRows as_display(const PictureRows& shown) {
    const auto rgb = colour_channels(shown.layout);
    std::vector<int> from(rgb.begin(), rgb.end());
    PictureLayout layout = shown.layout;
    layout.channels = {"R", "G", "B"};
    if (const int alpha = channel_index(shown.layout, "A"); alpha >= 0) {
        from.push_back(alpha);
        layout.channels.emplace_back("A");
    }
    const size_t channels = shown.layout.channels.size();
    const auto row = [from, channels, source = shown.row,
                      values = std::vector<float>(size_t(layout.width) * channels)](
                         int y, float* out) mutable {
        source(y, values.data());
        for (size_t i = 0; i < values.size(); i += channels)
            for (const int channel : from) *out++ = values[i + size_t(channel)];
    };
    return {std::move(layout), row};
}

}  // namespace petzval::io
