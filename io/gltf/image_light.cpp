// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/image_light.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/scene/cube_sky.h"
#include "core/spectrum/colour.h"
#include "io/base/error.h"
#include "io/base/json_cursor.h"
#include "io/image/picture_files.h"

namespace petzval::io {
namespace {

constexpr const char* kImageBasedLights = "EXT_lights_image_based";
constexpr int kHarmonicsHeight = 64;

/// The light that the drawn scene names, and its number.
std::optional<size_t> light_of_scene(const JsonCursor& root, int scene, size_t lights) {
    const auto scenes = root.objects("scenes");
    if (scene < 0) return std::nullopt;
    const auto extension = scenes[static_cast<size_t>(scene)].extension(kImageBasedLights);
    if (!extension) return std::nullopt;
    return extension->required_index("light", lights, "light");
}

/// Inverse of a light's rotation: what it takes a direction in the scene to.
M44f to_picture(const JsonCursor& light) {
    const auto q = light.numbers("rotation", 4);
    return q.empty() ? M44f() : M44f(rotation_matrix({-q[0], -q[1], -q[2], q[3]}));
}

/// RGB of a face: encoded as sRGB, and divided by alpha (RGBD) where there is some. Khronos,
/// EXT_lights_image_based, "HDR Images"; the encoding: glTF issue 1648.
std::vector<float> face_texels(const Image& image) {
    constexpr float least_alpha = 1.f / 255;
    const size_t count = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
    std::vector<float> rgb;
    rgb.reserve(3 * count);
    std::visit(
        [&](const auto& texels) {
            const float one =
                std::is_same_v<std::decay_t<decltype(texels[0])>, float> ? 1.f : 255.f;
            for (size_t i = 0; i < count; ++i) {
                const float alpha =
                    std::max(static_cast<float>(texels[4 * i + 3]) / one, least_alpha);
                for (size_t c = 0; c < 3; ++c)
                    rgb.push_back(srgb_to_linear(static_cast<float>(texels[4 * i + c]) / one) /
                                  alpha);
            }
        },
        image.texels);
    return rgb;
}

class Reader {
  public:
    Reader(const GltfModel& gltf, const JsonCursor& light, PictureBudget& pictures)
        : gltf_(gltf), light_(light), pictures_(pictures) {}

    /// The cube; nothing where an image of it is not there.
    std::optional<CubeFaces> cube() {
        CubeFaces cube{};
        const auto& first = light_.value()["specularImages"][0];
        for (size_t i = 0; i < 6; ++i) {
            const auto number = first[i].get<size_t>();
            const std::vector<uint8_t>& bytes = gltf_.source.images.at(number);
            if (bytes.empty()) return std::nullopt;
            const std::string place = json_path("images", number);
            const Image image = decode_image(bytes, gltf_.file, place, pictures_);
            if (image.width != image.height || (i > 0 && image.width != cube.size))
                throw InputError(gltf_.file, place,
                                 "is {}x{} texels; the faces of a cube must be squares of one size",
                                 image.width, image.height);
            cube.size = image.width;
            cube.texel[i] = face_texels(image);
        }
        return cube;
    }

    Harmonics harmonics() {
        Harmonics out;
        const auto& rows = light_.value()["irradianceCoefficients"];
        for (size_t i = 0; i < 9; ++i)
            for (size_t c = 0; c < 3; ++c) out[i].v[static_cast<int>(c)] = rows[i][c].get<float>();
        return out;
    }

    Sky sky(int height, const std::function<Rgb(const V3f&)>& radiance) {
        constexpr uint64_t bytes_per_texel = 28;  // the most while Sky::picture works
        const uint64_t texels = uint64_t{2} * uint64_t(height) * uint64_t(height);
        const std::string shortage =
            pictures_.take(texels * bytes_per_texel, texels * 3 * sizeof(float));
        if (!shortage.empty()) light_.fail("the sky " + shortage);
        const M44f turned = to_picture(light_);
        constexpr float most_nits = 1e20f;
        const auto intensity = static_cast<float>(light_.number_or("intensity", 1));
        auto rgb = sky_texels(
            height, [&](const V3f& d) { return radiance(transform_direction(d, turned)); });
        for (float& value : rgb) value = std::min(value * intensity, most_nits);
        return Sky::picture(std::move(rgb), 2 * height, height, 0.f, 1.f);
    }

  private:
    const GltfModel& gltf_;
    const JsonCursor& light_;
    PictureBudget& pictures_;
};

}  // namespace

std::optional<Sky> read_image_light(const GltfModel& gltf, const GltfNodes& nodes, GltfTally& tally,
                                    PictureBudget& pictures) {
    const JsonCursor root(gltf.source.json, gltf.file);
    const auto definitions = root.extension(kImageBasedLights);
    if (!definitions) return std::nullopt;
    const auto lights = definitions->objects("lights");
    const auto number = light_of_scene(root, nodes.scene, lights.size());
    if (!number) return std::nullopt;
    const JsonCursor& light = lights[*number];
    Reader reader(gltf, light, pictures);
    if (const auto cube = reader.cube()) {
        tally.honoured.insert(fmt::format("sky of a cube of {0}x{0} texels", cube->size));
        return reader.sky(2 * cube->size, [&](const V3f& d) { return cube->radiance(d); });
    }
    tally.warnings.add(light.path(),
                       "an image of its cube is not there; its irradiance coefficients "
                       "light the scene, and make a blurred sky");
    const Harmonics harmonics = reader.harmonics();
    return reader.sky(kHarmonicsHeight,
                      [&](const V3f& d) { return radiance_of_irradiance(harmonics, d); });
}

}  // namespace petzval::io
