// SPDX-License-Identifier: Apache-2.0
// Where the texture of a MASK material surely covers, and where it surely does not.
#pragma once

#include <optional>

#include "core/math/ray.h"
#include "core/scene/scene.h"

namespace petzval {

/// Answers of a material at places on its texture that are known to kMargin texels along each axis.
struct MaskMap {
    static constexpr int kMargin = 2;
    enum Answer : uint8_t { Hole = 1, Covered = 2, All = 3 };
    const std::vector<Image>& images;
    const TextureSlot& slot;
    /// Four a byte, by the upper left texel that is filtered, `All` where the exact place decides.
    /// Empty: the material is not MASK, or has no base-colour texture of 8 bits.
    std::vector<uint8_t> answers;

    MaskMap(const Scene&, const Material&);
};

/// A mesh with a map. The traversal finds where it is hit but for the rounding of its floats, which
/// grows with the way of the ray: a bound of that tells where the map will do.
class MaskedMesh {
  public:
    /// All must outlive it.
    MaskedMesh(const Scene&, const Mesh&, const MaskMap&);
    /// Whether only coverage() knows: the map is empty, the mesh changes its shape or has colours,
    /// or its texture coordinates are too many texels for floats.
    [[nodiscard]] bool empty() const { return corners_.empty(); }
    [[nodiscard]] size_t bytes() const { return corners_.size() * sizeof(Corners); }
    [[nodiscard]] const Scene& scene() const { return scene_; }

    /// Way that would round as much as moving a ray into the space of an instance does; infinite
    /// where that is not bounded well. t: of the hit.
    [[nodiscard]] static float rounding_of(const Instance&, const Ray& in_world, float t);
    /// Whether a triangle covers where a ray hits it, by what the traversal found in the mesh's
    /// space; nothing where only coverage() knows. ng: product of two edges; more: rounding_of.
    [[nodiscard]] std::optional<bool> covers(uint32_t triangle, V2f b, const V3f& ng,
                                             const V3f& direction, float t, float more) const {
        const float length = std::sqrt(direction.dot(direction)) + 1e-15f;  // above underflow
        const Corners& at = corners_[triangle];
        const float least = (at.doubt * (t * length + more) + at.more_doubt) * length + 1e-30f;
        if (!(std::fabs(ng.dot(direction)) > least)) return std::nullopt;
        const V2f uv = at.uv[0] * (1.f - b.x - b.y) + at.uv[1] * b.x + at.uv[2] * b.y;
        const uint32_t texel = locate_texture(map_.images, map_.slot, uv).texel[0];
        const int answer = map_.answers[texel / 4] >> (texel % 4 * 2) & MaskMap::All;
        if (answer != MaskMap::Hole && answer != MaskMap::Covered) return std::nullopt;
        return answer == MaskMap::Covered;
    }

  private:
    struct alignas(32) Corners {  // of a triangle, side by side
        std::array<V2f, 3> uv;
        float doubt, more_doubt;  // least |ng . unit direction| for a way of 1, and for none
    };
    const Scene& scene_;
    const MaskMap& map_;
    std::vector<Corners> corners_;
};

}  // namespace petzval
