// SPDX-License-Identifier: Apache-2.0
// Where the texture of a MASK material surely covers, and where it surely does not.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/scene/scene.h"

namespace petzval {

/// Answers of a MASK material at places on its texture that are known to kMargin texels.
class MaskMap {
  public:
    /// How far off a place may be along each axis, texels.
    static constexpr int kMargin = 2;

    /// The map of a material; nothing where it is not MASK, or has no base-colour texture of 8
    /// bits.
    [[nodiscard]] static std::optional<MaskMap> of(const Scene&, const Material&);
    /// Whether the surface covers about uv; nothing where that hangs on the exact place.
    [[nodiscard]] std::optional<bool> covers(V2f uv) const;
    [[nodiscard]] const TextureSlot& slot() const { return slot_; }
    [[nodiscard]] const Image& image() const { return images_[slot_.image]; }
    [[nodiscard]] size_t bytes() const { return answers_.size(); }

  private:
    MaskMap(const std::vector<Image>& images, const TextureSlot& slot)
        : images_(images), slot_(slot) {}

    const std::vector<Image>& images_;
    const TextureSlot& slot_;
    std::vector<uint8_t> answers_;  ///< two bits for each upper left texel
};

/// A mesh with a map. A traversal in floats hits it at barycentric coordinates that are off by
/// about its rounding times the way to the triangle: a bound of that says where they will do.
class MaskedMesh {
  public:
    /// Nothing where only coverage() knows: it changes its shape, has colours or no texture
    /// coordinates, or these are too many texels for floats. Scene and map must outlive it.
    [[nodiscard]] static std::optional<MaskedMesh> of(const Scene&, const Mesh&, const MaskMap&);
    /// What placing does to a ray that is moved into the mesh's space, as lengths in that space: x
    /// for each metre of |origin| + 2 t |direction| in world space, and y. Infinite where it is not
    /// bounded well.
    [[nodiscard]] static V2f rounding_of(const Instance&);

    /// Whether a triangle covers where a ray hits it; nothing where only coverage() knows. b, ng
    /// and t as the traversal found them, in the space of the mesh; more: length for rounding_of.
    [[nodiscard]] std::optional<bool> covers(uint32_t triangle, V2f b, const V3f& ng,
                                             const V3f& direction, float t, float more) const;
    [[nodiscard]] const Scene& scene() const { return scene_; }
    [[nodiscard]] size_t bytes() const { return corners_.size() * sizeof(Corners); }

  private:
    /// Of a triangle, side by side: texture coordinates of its corners, and the least |ng . unit
    /// direction| for a way of 1, and what is added to that.
    struct alignas(32) Corners {
        std::array<V2f, 3> uv;
        float doubt, more_doubt;
    };

    MaskedMesh(const Scene& scene, const MaskMap& map) : scene_(scene), map_(map) {}

    const Scene& scene_;
    const MaskMap& map_;
    std::vector<Corners> corners_;
};

inline std::optional<bool> MaskMap::covers(V2f uv) const {
    const uint32_t texel = locate_texture(images_, slot_, uv).texel[0];
    const int answer = answers_[texel / 4] >> (texel % 4 * 2) & 3;
    if (answer != 1 && answer != 2) return std::nullopt;
    return answer == 2;
}

inline std::optional<bool> MaskedMesh::covers(uint32_t triangle, V2f b, const V3f& ng,
                                              const V3f& direction, float t, float more) const {
    const float length = std::sqrt(direction.dot(direction)) + 1e-15f;  // above what underflows
    const Corners& at = corners_[triangle];
    const float least = (at.doubt * (t * length + more) + at.more_doubt) * length + 1e-30f;
    if (!(std::fabs(ng.dot(direction)) > least)) return std::nullopt;
    return map_.covers(at.uv[0] * (1.f - b.x - b.y) + at.uv[1] * b.x + at.uv[2] * b.y);
}

}  // namespace petzval
