// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <sstream>

#include "io/base/error.h"
#include "io/codec/codec.h"
#include "io/file/read_file.h"
#include "io/file/text_lines.h"
#include "io/picture/exr_header.h"
#include "io/picture/limits.h"
#include "io/picture/picture_kind.h"

namespace petzval::io::codec {
namespace {

/// The attributes of the file that are one number or one text; not those OpenImageIO adds for
/// itself.
Metadata metadata_of(const OIIO::ImageSpec& spec) {
    Metadata found;
    for (const OIIO::ParamValue& item : spec.extra_attribs) {
        const std::string name = item.name().string();
        if (name.starts_with("oiio:")) continue;
        if (item.type() == OIIO::TypeDesc::INT) found.emplace_back(name, item.get_int());
        if (item.type() == OIIO::TypeDesc::FLOAT) found.emplace_back(name, item.get_float());
        if (item.type() == OIIO::TypeDesc::STRING) found.emplace_back(name, item.get_string());
    }
    return found;
}

using Head = std::array<uint8_t, 30>;

/// What is looked at before a file is decoded: its size, and its first bytes with zeros behind its
/// end. Throws for what is no readable file.
struct Start {
    uint64_t size = 0;
    Head head{};

    explicit Start(const std::filesystem::path& path) {
        const InputFile in(path);
        if (!in.error().empty())
            throw InputError(path.string(), "",
                             in.error() == "is a folder"     ? "is a folder; name a picture in it"
                             : in.error().starts_with("is ") ? in.error()
                                                             : "cannot be read: " + in.error());
        size = in.size();
        static_cast<void>(in.read(head, 0));
    }
    [[nodiscard]] std::string_view begin() const {
        return {reinterpret_cast<const char*>(head.data()), std::min<size_t>(size, head.size())};
    }
    [[nodiscard]] std::string_view kind() const {
        static_assert(kPictureKindBytes <= sizeof(Head));
        return picture_kind(begin());
    }
};

InputError refusal(const std::filesystem::path& path, const std::string& why) {
    return {path.string(), "", "the picture " + why};
}

/// A picture whose header is read.
struct OpenPicture {
    std::unique_ptr<OIIO::ImageInput> input;
    OIIO::ImageSpec spec;
};

OpenPicture open_picture(const std::filesystem::path& path, const Start& start) {
    const auto refuse = [&](const std::string& why) { return refusal(path, why); };
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    const std::string_view kind = start.kind();
    if (kind.empty())
        throw refuse(
            fmt::format("cannot be read: it is {}no OpenEXR, Radiance, PNG, JPEG or WebP file; "
                        "convert it to one of these",
                        is_text(start.begin()) ? "a text file, and " : ""));
    if (const std::string why = kind == "exr" ? exr_header_complaint(path) : ""; !why.empty())
        throw refuse(why);
    // In two steps: OpenImageIO's open in one would offer a broken file to all its readers.
    auto input = OIIO::ImageInput::create(std::string(kind));
    if (!input) throw refuse("cannot be read: " + first_line(OIIO::geterror()));
    OIIO::ImageSpec spec;
    if (!input->open(path.string(), spec, config))
        throw refuse("cannot be read: " + first_line(input->geterror()));
    return {std::move(input), std::move(spec)};
}

Picture decode(const std::filesystem::path& path, PictureBudget& budget,
               std::optional<uint64_t> kept_per_pixel) {
    const auto refuse = [&](const std::string& why) { return refusal(path, why); };
    const Start start(path);
    if (const auto size = webp_size(start.head)) {
        const uint64_t decoded_bytes = uint64_t{4} * (*size)[0] * (*size)[1];
        PictureBudget spent = budget;
        const std::string shortage = spent.take(4 * decoded_bytes, decoded_bytes);
        if (!shortage.empty())
            throw refuse(fmt::format("of {}x{} pixels {}", (*size)[0], (*size)[1], shortage));
    }
    const auto [input, spec] = open_picture(path, start);
    const std::string why =
        size_complaint(spec.width, spec.height, spec.depth, spec.nchannels, start.size);
    if (!why.empty()) throw refuse(why);
    const uint64_t pixels = uint64_t(spec.width) * spec.height;
    const uint64_t float_bytes = pixels * spec.nchannels * sizeof(float);
    const std::string shortage = kept_per_pixel ? budget.take(pixels * *kept_per_pixel, float_bytes)
                                                : budget.take(float_bytes, 0);
    if (!shortage.empty())
        throw refuse(fmt::format("of {}x{} pixels with {} channels {}", spec.width, spec.height,
                                 spec.nchannels, shortage));

    Picture picture{{.width = spec.width,
                     .height = spec.height,
                     .x = spec.x - spec.full_x,
                     .y = spec.y - spec.full_y,
                     .full_width = spec.full_width,
                     .full_height = spec.full_height,
                     .channels = spec.channelnames,
                     .metadata = metadata_of(spec)},
                    {}};
    picture.for_display =
        !spec.format.is_floating_point() && input->format_name() != std::string_view("openexr");
    picture.pixels.resize(size_t(spec.width) * spec.height * spec.nchannels);
    const bool success =
        input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, picture.pixels.data());
    const std::string error = first_line(input->geterror());
    if (!success || is_cut_short(error)) throw refuse("cannot be read: " + error);
    return picture;
}

}  // namespace

Picture read_picture(const std::filesystem::path& path, PictureBudget& budget,
                     std::optional<uint64_t> kept_per_pixel) {
    return naming_file(path.string(), [&] { return decode(path, budget, kept_per_pixel); });
}

Metadata read_metadata(const std::filesystem::path& path) {
    Metadata out = metadata_of(open_picture(path, Start(path)).spec);
    const auto found = std::find_if(
        out.begin(), out.end(), [](const auto& one) { return one.first == "ImageDescription"; });
    if (found == out.end() || !std::holds_alternative<std::string>(found->second)) return out;
    std::istringstream words(std::get<std::string>(found->second));
    for (std::string word; words >> word;)
        if (const size_t at = word.find('='); word.starts_with(kOwnMetadata) && at != word.npos)
            out.emplace_back(word.substr(0, at), word.substr(at + 1));
    return out;
}

}  // namespace petzval::io::codec
