// SPDX-License-Identifier: Apache-2.0
#include "io/image/picture_files.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "io/base/error.h"
#include "io/base/machine.h"
#include "io/base/printable.h"
#include "io/build/build.h"
#include "io/file/program_file.h"
#include "io/picture/image_codec.h"

namespace petzval::io {
namespace {

InputError cannot_load(const std::filesystem::path& path, const std::string& why) {
    return {path.string(), "",
            fmt::format("cannot be loaded ({}); install Petzval again with cmake --install", why)};
}

/// The module's functions. The linker loads it once, and never unloads it.
const ImageCodec& image_codec() {
    const std::filesystem::path path = installed_file(PETZVAL_IMAGE_CODEC_FROM_BIN);
    const auto reason = [] {
        const char* text = ::dlerror();
        return std::string(text ? text : "no reason given");
    };
    // All at once: a function that is missing must not end the program in the middle of a write.
    void* const module = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!module) throw cannot_load(path, reason());
    void* const symbol = ::dlsym(module, kImageCodecSymbol);
    if (!symbol) throw cannot_load(path, reason());
    const ImageCodec& codec = *reinterpret_cast<const ImageCodec* (*)()>(symbol)();
    if (std::string_view(codec.version) != program_version())
        throw cannot_load(path, fmt::format("it is of {}, and this is {}", printable(codec.version),
                                            program_version()));
    return codec;
}

}  // namespace

Picture read_picture(const std::filesystem::path& path, PictureBudget& budget,
                     std::optional<uint64_t> kept_per_pixel) {
    return image_codec().read_picture(path, budget, kept_per_pixel);
}

Picture read_picture(const std::filesystem::path& path) {
    PictureBudget budget;
    return read_picture(path, budget);
}

Metadata read_metadata(const std::filesystem::path& path) {
    return image_codec().read_metadata(path);
}

Image decode_image(const std::vector<uint8_t>& bytes, const std::string& file,
                   const std::string& place, PictureBudget& budget) {
    ColourRemarks unread;
    return decode_image(bytes, file, place, budget, unread);
}

Image decode_image(const std::vector<uint8_t>& bytes, const std::string& file,
                   const std::string& place, PictureBudget& budget, ColourRemarks& remarks) {
    return image_codec().decode_image(bytes, file, place, budget, remarks);
}

void write_exr(const std::filesystem::path& path, const PictureRows& picture) {
    image_codec().write_exr(path, picture);
}

void write_8bit(const std::filesystem::path& path, const PictureRows& encoded, bool srgb) {
    image_codec().write_8bit(path, encoded, srgb);
}

Picture draw_text(const std::string& utf8, int letter_px, const std::filesystem::path& font) {
    return image_codec().draw_text(utf8, letter_px, font);
}

void load_image_codec() {
    static_cast<void>(image_codec());
}

void limit_picture_threads(int threads) {
    // The module, which takes its time to load, begins with this limit.
    if (threads < usable_threads()) image_codec().limit_threads(threads);
}

}  // namespace petzval::io
