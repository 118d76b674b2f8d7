// SPDX-License-Identifier: Apache-2.0
// Textures: encoded bytes to RGBA texels.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <string_view>

#include "io/base/error.h"
#include "io/codec/codec.h"
#include "io/codec/colour_space.h"
#include "io/file/text_lines.h"
#include "io/picture/limits.h"
#include "io/picture/picture_kind.h"
#include "io/picture/seal.h"

namespace petzval::io::codec {
namespace {

/// Ending of the format, where it is one that glTF has; else empty.
std::string_view ending_of(const std::vector<uint8_t>& bytes) {
    const std::string_view head(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::string_view kind = picture_kind(head.substr(0, kPictureKindBytes));
    return kind == "png" || kind == "jpg" || kind == "webp" ? kind : "";
}

/// "of 4096x4096 pixels with 3 channels ", for messages.
std::string described(int width, int height, int channels) {
    return fmt::format("of {}x{} pixels with {} channels ", width, height, channels);
}

/// Spreads 1 (grey), 2 (grey, alpha) or 3 (colour) channels of every texel to RGBA.
template <class T>
std::vector<T> to_rgba(std::vector<T> in, int channels, T opaque) {
    if (channels == 4) return in;
    const size_t count = in.size() / channels;
    std::vector<T> out(count * 4);
    for (size_t i = 0; i < count; ++i) {
        const T* texel = &in[i * channels];
        const bool grey = channels < 3;
        out[i * 4] = texel[0];
        out[i * 4 + 1] = grey ? texel[0] : texel[1];
        out[i * 4 + 2] = grey ? texel[0] : texel[2];
        out[i * 4 + 3] = channels == 2 ? texel[1] : opaque;
    }
    return out;
}

ColourRemarks remarks_of(const OIIO::ImageSpec& spec, const std::vector<uint8_t>& bytes,
                         std::string_view ending) {
    ColourRemarks remarks;
    const std::string_view inks = spec.get_string_attribute("jpeg:ColorSpace");
    remarks.inks = inks == "CMYK" || inks == "YCbCrK";
    std::span<const uint8_t> profile;
    if (const OIIO::ParamValue* found = spec.find_attribute("ICCProfile");
        found && found->type().basetype == OIIO::TypeDesc::UINT8)
        profile = {static_cast<const uint8_t*>(found->data()),
                   static_cast<size_t>(found->datasize())};
    if (!remarks.inks)  // the profile of inks says nothing of what was made of them
        remarks.other_space =
            ending == "png" ? other_space_of_png(bytes, profile) : other_space_of_profile(profile);
    return remarks;
}

}  // namespace

Image decode_image(const std::vector<uint8_t>& bytes, const std::string& file,
                   const std::string& place, PictureBudget& budget, ColourRemarks& remarks) {
    const auto refuse = [&](const std::string& why) -> InputError {
        return {file, place, "the image " + why};
    };
    const std::string_view ending = ending_of(bytes);
    if (ending.empty()) throw refuse("is not a PNG, JPEG or WebP file; convert it to one of these");

    // libpng would find out too, but print a line of its own, and OpenImageIO would leak its
    // message.
    if (ending == "png" && !is_whole_png(bytes, false)) throw refuse("is a PNG that is cut short");

    if (const auto size = webp_size(bytes)) {
        const uint64_t decoded_bytes = uint64_t{4} * (*size)[0] * (*size)[1];
        PictureBudget spent = budget;
        const std::string shortage = spent.take(decoded_bytes, decoded_bytes);
        if (!shortage.empty()) throw refuse(described((*size)[0], (*size)[1], 4) + shortage);
    }

    OIIO::Filesystem::IOMemReader reader(bytes.data(), bytes.size());
    OIIO::Filesystem::IOProxy* proxy = &reader;
    OIIO::ImageSpec config;
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    config.attribute("oiio:UnassociatedAlpha", 1);
    // In two steps: OpenImageIO's open in one would offer broken bytes to all its readers.
    const auto input = OIIO::ImageInput::create(std::string(ending));
    if (!input) throw refuse("cannot be decoded: " + first_line(OIIO::geterror()));
    OIIO::ImageSpec spec;
    if (!input->open(fmt::format("memory.{}", ending), spec, config))
        throw refuse("cannot be decoded: " + first_line(input->geterror()));
    const std::string why =
        size_complaint(spec.width, spec.height, spec.depth, spec.nchannels, bytes.size());
    if (!why.empty()) throw refuse(why);

    const size_t pixels = size_t(spec.width) * spec.height, count = pixels * spec.nchannels;
    const bool bytewise = spec.format == OIIO::TypeDesc::UINT8;
    const uint64_t value_bytes = bytewise ? sizeof(uint8_t) : sizeof(float);
    const std::string shortage = budget.take(4 * pixels * value_bytes, count * value_bytes);
    if (!shortage.empty())
        throw refuse(described(spec.width, spec.height, spec.nchannels) + shortage);
    const auto read = [&](OIIO::TypeDesc type, void* to) {
        const bool success = input->read_image(0, 0, 0, spec.nchannels, type, to);
        const std::string error = first_line(input->geterror());
        if (!success || is_cut_short(error)) throw refuse("cannot be decoded: " + error);
    };
    remarks = remarks_of(spec, bytes, ending);
    Image image{.name = "", .width = spec.width, .height = spec.height, .texels = {}};
    if (bytewise) {
        std::vector<uint8_t> texels(count);
        read(OIIO::TypeDesc::UINT8, texels.data());
        image.texels = to_rgba<uint8_t>(std::move(texels), spec.nchannels, 255);
    } else {
        std::vector<float> texels(count);
        read(OIIO::TypeDesc::FLOAT, texels.data());
        image.texels = to_rgba<float>(std::move(texels), spec.nchannels, 1.f);
    }
    return image;
}

}  // namespace petzval::io::codec
