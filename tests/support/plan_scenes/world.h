// SPDX-License-Identifier: Apache-2.0
// What scenes for plans are made of: dice, materials, shapes and a view.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/math/math.h"
#include "tests/support/plan_scenes/plan_scenes.h"
#include "tests/support/tiny_gltf.h"

namespace petzval::test {

/// Random numbers that follow from a seed, one after the other. No expression may take two of them
/// but in braces: compilers evaluate in orders of their own.
class PlanDice {
  public:
    explicit PlanDice(uint32_t seed) : seed_(seed) {}

    [[nodiscard]] float between(float low, float high) {
        return low + (high - low) * to_unit_float(hash32(seed_, next_++));
    }
    /// As likely in each octave.
    [[nodiscard]] float log_between(float low, float high) {
        return std::exp(between(std::log(low), std::log(high)));
    }
    [[nodiscard]] int whole(int low, int high) {  // both included
        return std::min(high, low + static_cast<int>(between(0, 1) * float(high - low + 1)));
    }
    [[nodiscard]] bool chance(float share) { return between(0, 1) < share; }
    [[nodiscard]] float sign() { return chance(0.5f) ? 1.f : -1.f; }
    template <class T, size_t N>
    [[nodiscard]] const T& pick(const std::array<T, N>& of) {
        return of[static_cast<size_t>(whole(0, int(N) - 1))];
    }
    /// Within a cube from -1 to 1.
    [[nodiscard]] V3f anywhere() { return {between(-1, 1), between(-1, 1), between(-1, 1)}; }
    /// White in half of the cases.
    [[nodiscard]] V3f colour() {
        return chance(0.5f) ? V3f(1.f) : V3f{between(0, 1), between(0, 1), between(0, 1)};
    }

  private:
    uint32_t seed_, next_ = 0;
};

/// Materials as glTF has them.
[[nodiscard]] nlohmann::json matt(V3f colour);
[[nodiscard]] nlohmann::json glowing(float nits, V3f colour = V3f(1.f));
/// Of random colour, and of nits between these.
[[nodiscard]] nlohmann::json random_glow(PlanDice&, float low, float high);
[[nodiscard]] nlohmann::json glass(float ior, float dispersion);
[[nodiscard]] nlohmann::json shiny_metal(V3f colour, float roughness);
/// Adds an entry to extras.petzval: {"metal": "au"}, say.
[[nodiscard]] nlohmann::json with_extra(nlohmann::json material, const char* key,
                                        const std::string& name);

/// A camera at the origin that looks towards -z, y up. Pixels count from the upper left corner.
struct PlanView {
    V2i size{64, 36};
    float tan_up = 0.3f;  ///< tangent of half the vertical angle

    [[nodiscard]] float pixel_m(float depth) const { return 2 * tan_up * depth / float(size.y); }
    [[nodiscard]] V3f at(V2f px, float depth) const {
        const float unit = pixel_m(depth);
        return {(px.x - 0.5f * float(size.x)) * unit, (0.5f * float(size.y) - px.y) * unit, -depth};
    }
    [[nodiscard]] V2f pixel_of(V3f p) const {
        const float unit = pixel_m(-p.z);
        return {p.x / unit + 0.5f * float(size.x), 0.5f * float(size.y) - p.y / unit};
    }
};

/// A scene while it grows.
class PlanWorld {
  public:
    PlanWorld(uint32_t index, const char* kind);

    PlanDice dice;
    PlanScene scene;
    PlanView view;
    bool large = false;  ///< the frame is large, and only what is covered matters

    [[nodiscard]] bool decoy() const { return scene.decoy; }
    /// Takes a large frame, but for decoys, which matter everywhere.
    void maybe_large(float share, int narrowest = 320, int widest = 640);

    void pinhole(float fov_deg);
    void thin_lens(float fov_deg, float radius_m, float focus_m);
    /// A lens that ships, on a film 36 mm wide.
    void real_lens(const std::string& name, float focal_mm, float focus_m);

    int material(nlohmann::json);
    /// A parallelogram corner + s*a + t*b, seen from both sides; texture coordinates 0 to 1.
    void quad(V3f corner, V3f a, V3f b, int material);
    /// A square card that faces the camera, its middle at `middle`.
    void card(V3f middle, float half_m, int material) {
        quad(middle - V3f(half_m, half_m, 0), {2 * half_m, 0, 0}, {0, 2 * half_m, 0}, material);
    }
    void ball(V3f middle, float radius, int material, int rows = 16);
    /// Flat faces of a convex body around its middle; each at least three corners.
    void body(const std::vector<V3f>& corners, const std::vector<std::vector<int>>& faces,
              int material);
    /// Texture of square texels, its index; colours: 0 to 1, row by row.
    int texture(uint32_t width, uint32_t height, const std::vector<V3f>& colours);
    /// A point light (candela), or a sun (lux) where `towards` is not 0.
    void lamp(V3f at, V3f towards, float intensity);
    /// A wall behind everything that glows evenly.
    void even_wall(float nits);
    /// Big balls in soft light: a smooth picture.
    void soft_stage();

    /// Pixels around a point matter, so far from it.
    void covers(V3f at, float radius_px);
    /// The scene as it stands.
    [[nodiscard]] PlanScene finish();

  private:
    void mesh(const std::vector<float>& positions, const std::vector<float>& normals,
              const std::vector<float>& uv, const std::vector<uint32_t>& indices, int material);
    void look();

    TinyGltf file_;
};

}  // namespace petzval::test
