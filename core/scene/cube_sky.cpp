// SPDX-License-Identifier: Apache-2.0
#include "core/scene/cube_sky.h"

#include <algorithm>

#include "core/math/trig.h"

namespace petzval {
namespace {

struct Face {
    V3f forward, right, down;
};
const std::array<Face, 6> kFaces = {{{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                                     {{-1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
                                     {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},
                                     {{0, -1, 0}, {-1, 0, 0}, {0, 0, -1}},
                                     {{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}},
                                     {{0, 0, -1}, {1, 0, 0}, {0, -1, 0}}}};

}  // namespace

Rgb CubeFaces::radiance(const V3f& d) const {
    const V3f a = abs(d);
    const int axis = a.x >= std::max(a.y, a.z) ? 0 : a.y >= a.z ? 1 : 2;
    const auto number = static_cast<size_t>(2 * axis + (d[axis] < 0.f));
    const Face& face = kFaces[number];
    const float along = d.dot(face.forward);
    if (!(along > 0.f)) return Rgb(0.f);
    const auto position = [&](const V3f& across) {
        const float at = (d.dot(across) / along + 1.f) / 2.f * static_cast<float>(size) - 0.5f;
        return std::clamp(at, 0.f, static_cast<float>(size - 1));
    };
    const float x = position(face.right), y = position(face.down);
    const int left = std::min(static_cast<int>(x), std::max(size - 2, 0));
    const int top = std::min(static_cast<int>(y), std::max(size - 2, 0));
    const int right = std::min(left + 1, size - 1), below = std::min(top + 1, size - 1);
    const auto at = [&](int column, int row) {
        const float* const t =
            &texel[number][3 * (static_cast<size_t>(row) * static_cast<size_t>(size) +
                                static_cast<size_t>(column))];
        return f4{t[0], t[1], t[2], 0.f};
    };
    const auto mixed = [&](int row) {
        return at(left, row) + (at(right, row) - at(left, row)) * (x - static_cast<float>(left));
    };
    return Rgb(mixed(top) + (mixed(below) - mixed(top)) * (y - static_cast<float>(top)));
}

Rgb radiance_of_irradiance(const Harmonics& irradiance, const V3f& d) {
    const std::array<float, 9> basis = {0.282095f,
                                        0.488603f * d.y,
                                        0.488603f * d.z,
                                        0.488603f * d.x,
                                        1.092548f * d.x * d.y,
                                        1.092548f * d.y * d.z,
                                        0.315392f * (3.f * d.z * d.z - 1.f),
                                        1.092548f * d.x * d.z,
                                        0.546274f * (d.x * d.x - d.y * d.y)};
    constexpr std::array<float, 3> cosine = {kPi, 2 * kPi / 3, kPi / 4};
    f4 sum{};
    for (size_t i = 0; i < 9; ++i)
        sum += irradiance[i].v * (basis[i] / cosine[i == 0 ? 0 : i < 4 ? 1 : 2]);
    return Rgb(max(sum, f4{}));
}

std::vector<float> sky_texels(int height, const std::function<Rgb(const V3f&)>& radiance) {
    const int width = 2 * height;
    std::vector<float> rgb;
    rgb.reserve(3 * static_cast<size_t>(width) * static_cast<size_t>(height));
    for (int y = 0; y < height; ++y) {
        const SinCos polar = sincos_turns((static_cast<float>(y) + 0.5f) / (2.f * height));
        for (int x = 0; x < width; ++x) {
            const SinCos azimuth = sincos_turns((static_cast<float>(x) + 0.5f) / width - 0.5f);
            const Rgb found =
                radiance({polar.sine * azimuth.cosine, polar.cosine, polar.sine * azimuth.sine});
            for (int c = 0; c < 3; ++c) rgb.push_back(found.v[c]);
        }
    }
    return rgb;
}

}  // namespace petzval
