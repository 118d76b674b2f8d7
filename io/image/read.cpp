// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/imageio.h>

#include <array>
#include <fstream>
#include <system_error>

#include "io/base/error.h"
#include "io/image/limits.h"
#include "io/image/oiio_message.h"
#include "io/image/picture.h"

namespace petzval {
namespace {

using Metadata = decltype(Picture::metadata);

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

/// Size on disk; throws for what is no readable file.
uint64_t size_on_disk(const std::filesystem::path& path) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error))
        throw InputError(path.string(), "", "is a folder; name a picture in it");
    const uint64_t size = std::filesystem::file_size(path, error);
    if (error) throw InputError(path.string(), "", "cannot be read: " + error.message());
    return size;
}

/// Whether the file begins as Ward's Radiance pictures do, which OpenImageIO does not ask for.
bool has_radiance_magic(const std::filesystem::path& path) {
    std::array<char, 2> head{};
    std::ifstream(path, std::ios::binary).read(head.data(), head.size());
    return head[0] == '#' && head[1] == '?';
}

}  // namespace

Picture read_picture(const std::filesystem::path& path) {
    const auto refuse = [&](const std::string& why) -> InputError {
        return {path.string(), "", "the picture " + why};
    };
    const uint64_t byte_count = size_on_disk(path);
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    // In two steps: OpenImageIO's open in one would offer a broken file to all its readers.
    const auto input = OIIO::ImageInput::create(path.string());
    if (!input) throw refuse("cannot be read: " + first_line(OIIO::geterror()));
    OIIO::ImageSpec spec;
    if (!input->open(path.string(), spec, config))
        throw refuse("cannot be read: " + first_line(input->geterror()));
    if (input->format_name() == std::string_view("hdr") && !has_radiance_magic(path))
        throw refuse("cannot be read: it does not begin with #? as Radiance files do");
    const std::string why =
        size_complaint(spec.width, spec.height, spec.depth, spec.nchannels, byte_count);
    if (!why.empty()) throw refuse(why);

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

}  // namespace petzval
