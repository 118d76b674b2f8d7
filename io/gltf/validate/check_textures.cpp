// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "io/base/json_parse.h"
#include "io/gltf/schema/extensions.h"
#include "io/gltf/validate/check.h"

namespace petzval::io {
namespace {

/// A RIFF container of the form type WEBP (RFC 9649, section 2.4).
bool is_webp(const std::vector<uint8_t>& bytes) {
    constexpr std::array<uint8_t, 4> riff = {'R', 'I', 'F', 'F'}, webp = {'W', 'E', 'B', 'P'};
    return bytes.size() >= 12 && std::equal(riff.begin(), riff.end(), bytes.begin()) &&
           std::equal(webp.begin(), webp.end(), bytes.begin() + 8);
}

bool declares(const JsonCursor& root, const char* extension) {
    const auto at = root.value().find("extensionsUsed");
    return at != root.value().end() && std::find(at->begin(), at->end(), extension) != at->end();
}

void check_images(GltfCheck& check) {
    if (declares(check.root, "EXT_texture_webp")) return;
    const auto images = check.root.objects("images");
    for (size_t i = 0; i < images.size(); ++i)
        if (is_webp(check.source.images[i]))
            check.warn(images[i],
                       "is a WebP image, and EXT_texture_webp is not declared; it is "
                       "read all the same");
}

std::string_view texture_advice(std::string_view extension) {
    return find_gltf_extension(extension) ? gltf_extension_advice(extension)
                                          : "export it with PNG, JPEG or WebP";
}

void check_texture(const GltfCheck& check, const JsonCursor& texture) {
    const size_t images = check.count("images");
    (void)texture.index("sampler", check.count("samplers"), "sampler");
    const auto source = texture.index("source", images, "image");
    // Extensions that replace the image (WebP, AVIF, KTX2 ...) all call it "source".
    const auto extensions = texture.find_object("extensions");
    if (!extensions) return;
    for (const auto& [name, unused] : extensions->value().items())
        if (extensions->object(name.c_str()).index("source", images, "image") && !source)
            texture.fail(fmt::format("its image is only in {}, which is not supported; {}",
                                     printable(name), texture_advice(name)));
}

}  // namespace

void check_textures(GltfCheck& check) {
    check_images(check);
    for (const JsonCursor& sampler : check.root.objects("samplers"))
        for (const char* key : {"magFilter", "minFilter", "wrapS", "wrapT"})
            if (sampler.has(key)) (void)sampler.integer(key);
    for (const JsonCursor& texture : check.root.objects("textures")) check_texture(check, texture);
}

}  // namespace petzval::io
