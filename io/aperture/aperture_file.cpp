// SPDX-License-Identifier: Apache-2.0
#include "io/aperture/aperture_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "io/base/ascii.h"
#include "io/base/error.h"
#include "io/base/nearest.h"
#include "io/image/picture_files.h"

namespace petzval::io {
namespace fs = std::filesystem;
namespace {

constexpr const char* kPossible =
    "give circle, square, triangle, rhomboid, frame, star:N, polygon:N[,ROTATION_DEG[,ROUNDNESS]], "
    "or a file .svg or .png";

// Distance from [0, 1] that is a drawing program's rounding.
constexpr float kRounding = 0.002f;

// The numbers after the colon; nothing where one of them is none.
std::optional<std::vector<double>> numbers_of(std::string_view text) {
    std::vector<double> out;
    for (;;) {
        const std::string_view part = text.substr(0, text.find(','));
        double value = 0;
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
        if (error != std::errc() || end != part.data() + part.size()) return std::nullopt;
        out.push_back(value);
        if (part.size() == text.size()) return out;
        text.remove_prefix(part.size() + 1);
    }
}

// Count as the shapes take it; -1, which they refuse, for a number that is not whole.
int count_of(double value) {
    return value >= 0 && value <= 1e6 && value == std::floor(value) ? static_cast<int>(value) : -1;
}

std::optional<camera::ApertureShape> built_in(const std::string& as_typed) {
    const std::string text = lower(as_typed);
    if (text == "circle") return camera::Disk();
    if (text == "square") return camera::square();
    if (text == "triangle") return camera::regular_polygon(3);
    if (text == "rhomboid") return camera::rhomboid();
    if (text == "frame") return camera::frame();
    const size_t colon = text.find(':');
    const std::string name = text.substr(0, colon);
    if (name != "star" && name != "polygon") return std::nullopt;
    if (colon == text.npos)
        throw ArgumentError(text, "", "needs a number; did you mean {}:5?", name);
    const auto v = numbers_of(std::string_view(text).substr(colon + 1));
    if (!v || v->size() > (name == "star" ? 1 : 3)) throw ArgumentError(text, "", kPossible);
    try {
        if (name == "star") return camera::star(count_of((*v)[0]));
        return camera::regular_polygon(count_of((*v)[0]), v->size() > 1 ? (*v)[1] : 0,
                                       v->size() > 2 ? (*v)[2] : 0);
    } catch (const std::invalid_argument& error) {
        throw ArgumentError(text, "", error.what());
    }
}

}  // namespace

camera::ApertureShape parse_aperture(const std::string& text, const fs::path& folder,
                                     PictureBudget pictures) {
    if (auto shape = built_in(text)) return *shape;
    const fs::path path = folder / text;
    const std::string ending = lower(path.extension().string());
    std::error_code none;
    if (ending.empty() || !fs::exists(path, none))
        throw ArgumentError(
            text, "", "is neither a file nor a shape; {}{}", kPossible,
            did_you_mean(text.substr(0, text.find(':')),
                         {"circle", "square", "triangle", "rhomboid", "frame", "star", "polygon"}));
    if (ending == ".svg") return read_svg_aperture(path);
    return read_mask_aperture(path, pictures);
}

camera::Mask read_mask_aperture(const fs::path& path, PictureBudget pictures) {
    constexpr uint64_t mask_bytes_per_texel = 20;  // its texels and the table that draws points
    const Picture picture = read_picture(path, pictures, mask_bytes_per_texel);
    const int red = channel_index(picture, "R"), green = channel_index(picture, "G"),
              blue = channel_index(picture, "B"), alpha = channel_index(picture, "A");
    const bool colour = red >= 0 && green >= 0 && blue >= 0;
    // EXR alone stores colours that are multiplied by alpha already.
    const bool by_alpha = alpha >= 0 && lower(path.extension().string()) != ".exr";
    camera::Mask mask{picture.width, picture.height, {}};
    mask.texels.reserve(static_cast<size_t>(picture.width) * picture.height);
    for (size_t i = 0; i < picture.pixels.size(); i += picture.channels.size()) {
        const float* p = &picture.pixels[i];
        // White must stay 1, which the sum of the weights is not to the last bit.
        const float grey = !colour || (p[red] == p[green] && p[green] == p[blue])
                               ? p[colour ? red : 0]
                               : 0.2126f * p[red] + 0.7152f * p[green] + 0.0722f * p[blue];
        const float open = by_alpha ? grey * p[alpha] : grey;
        const float clamped = std::clamp(open, 0.f, 1.f);  // keeps what is no number
        mask.texels.push_back(std::fabs(open - clamped) <= kRounding ? clamped : open);
    }
    if (const auto fault = camera::find_fault(mask))
        throw InputError(path.string(), "", *fault + "; 0 is opaque and 1 is open");
    return mask;
}

}  // namespace petzval::io
