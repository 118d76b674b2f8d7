// SPDX-License-Identifier: Apache-2.0
// Pictures are encoded in memory and written by ourselves: OpenImageIO's JPEG writer ends the
// program on a full disk, its PNG writer reports success.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <stdexcept>

#include "io/atomic_file.h"
#include "io/decoder_message.h"
#include "io/error.h"
#include "io/image.h"

namespace petzval {
namespace {

/// The bytes of a file with that ending.
std::vector<uint8_t> encode(const std::filesystem::path& path, const std::string& ending,
                            OIIO::ImageSpec spec, const void* pixels) {
    std::vector<uint8_t> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    OIIO::Filesystem::IOProxy* proxy = &memory;
    spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    const auto output = OIIO::ImageOutput::create(ending);
    if (!output)
        throw InputError(path.string(), "", "cannot be encoded: " + first_line(OIIO::geterror()));
    if (!output->open("memory." + ending, spec) || !output->write_image(spec.format, pixels) ||
        !output->close())
        throw InputError(path.string(), "", "cannot be encoded: " + first_line(output->geterror()));
    return bytes;
}

void check_shape(const Picture& picture) {
    const size_t count = size_t(picture.width) * picture.height * picture.channels.size();
    if (picture.width <= 0 || picture.height <= 0 || picture.pixels.size() != count)
        throw std::invalid_argument("a picture's pixels do not match its size and channels");
}

OIIO::ImageSpec exr_spec(const Picture& picture) {
    OIIO::ImageSpec spec(picture.width, picture.height, int(picture.channels.size()),
                         OIIO::TypeDesc::FLOAT);
    spec.x = picture.x;
    spec.y = picture.y;
    spec.full_width = picture.full_width;
    spec.full_height = picture.full_height;
    spec.channelnames = picture.channels;
    spec.attribute("DateTime", "");  // else the time of writing goes in
    for (const auto& [name, value] : picture.metadata)
        std::visit([&, &key = name](const auto& v) { spec.attribute(key, v); }, value);
    spec.attribute("compression", "zip");
    return spec;
}

/// Nearest of 256 levels; what is not a number is black.
uint8_t to_8bit(float value) {
    return value > 0.f ? static_cast<uint8_t>(std::min(value, 1.f) * 255.f + 0.5f) : 0;
}

}  // namespace

int channel_index(const Picture& picture, std::string_view name) {
    const auto found = std::find(picture.channels.begin(), picture.channels.end(), name);
    return found == picture.channels.end() ? -1 : int(found - picture.channels.begin());
}

PictureFormat picture_format(const std::filesystem::path& path) {
    std::string ending = path.extension().string();
    for (char& c : ending)
        if (c >= 'A' && c <= 'Z') c += 'a' - 'A';
    if (ending == ".exr") return PictureFormat::Exr;
    if (ending == ".png") return PictureFormat::Png;
    if (ending == ".jpg" || ending == ".jpeg") return PictureFormat::Jpeg;
    throw InputError(path.string(), "", "a picture's name must end in .exr, .png, .jpg or .jpeg");
}

void write_exr(const std::filesystem::path& path, const Picture& picture) {
    check_shape(picture);
    write_file_atomically(path, encode(path, "exr", exr_spec(picture), picture.pixels.data()));
}

void write_8bit(const std::filesystem::path& path, const Picture& encoded) {
    check_shape(encoded);
    const bool png = picture_format(path) == PictureFormat::Png;
    std::vector<int> from;
    for (const char* name : {"R", "G", "B"}) from.push_back(channel_index(encoded, name));
    if (*std::min_element(from.begin(), from.end()) < 0)
        throw std::invalid_argument("a display picture needs channels R, G and B");
    if (const int alpha = channel_index(encoded, "A"); png && alpha >= 0) from.push_back(alpha);

    std::vector<uint8_t> pixels;
    pixels.reserve(size_t(encoded.width) * encoded.height * from.size());
    for (size_t i = 0; i < encoded.pixels.size(); i += encoded.channels.size())
        for (const int channel : from) pixels.push_back(to_8bit(encoded.pixels[i + channel]));

    OIIO::ImageSpec spec(encoded.width, encoded.height, int(from.size()), OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("CompressionQuality", 95);
    spec.attribute("jpeg:subsampling", "4:4:4");  // small coloured lights keep their colour
    write_file_atomically(path, encode(path, png ? "png" : "jpg", spec, pixels.data()));
}

}  // namespace petzval
