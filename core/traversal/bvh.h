// SPDX-License-Identifier: Apache-2.0
// Ray traversal. Only this room sees Embree.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/math/ray.h"
#include "core/scene/scene.h"
#include "core/traversal/traversal_options.h"

struct RTCSceneTy;

namespace petzval {

/// Light that passes between the ends of a shadow ray.
struct Passage {
    float left;  ///< share of the light that BLEND surfaces leave; 0: the way is not free
    bool panes;  ///< what may be a pane (Material::may_be_pane) is on the way, which is not in
                 ///< `left`
};

class Bvh {
  public:
    /// Builds the hierarchy. It shares the scene's vertex and index buffers: the scene must outlive
    /// the Bvh, unchanged. Throws std::bad_alloc where memory is short, and std::runtime_error
    /// where Embree fails otherwise.
    Bvh(const Scene&, Traversal);
    ~Bvh();
    Bvh(const Bvh&) = delete;
    Bvh& operator=(const Bvh&) = delete;

    /// Nearest hit in (0, t_max]. passed: BLEND surfaces that are not met again; the ray meets
    /// nearly all others (chance_met). Without it, or where it is full, whether the ray meets a
    /// BLEND surface is drawn with the chance of its alpha.
    [[nodiscard]] std::optional<Hit> intersect(const Ray&,
                                               const PassedBlends* passed = nullptr) const;
    /// Nearest hit in [t_min, t_max] of a face whose front the ray meets; passed as above.
    [[nodiscard]] std::optional<Hit> intersect_front(const Ray&, float t_min,
                                                     const PassedBlends* passed) const;
    /// Whether anything but what may be a pane lies in (0, t_max).
    [[nodiscard]] bool occluded(const Ray&) const;
    /// Light that passes (0, t_max). BLEND surfaces are weighed up to PassedBlends::kMost; where
    /// more are on the way, each is drawn with the chance of its alpha.
    [[nodiscard]] Passage passage(const Ray&) const;
    /// All hits in (0, t_max], in no order, each once. Only of a scene with closed volumes
    /// (Scene::volume_boxes); others have none.
    [[nodiscard]] std::vector<Hit> all_hits(const Ray&) const;
    /// Whether some material is MASK or BLEND, so that rays need their alpha_seed.
    [[nodiscard]] bool has_cutouts() const;
    /// Whether some material is weighed (Material::weighed).
    [[nodiscard]] bool has_blends() const;
    /// Memory that the hierarchy takes beside the scene's own buffers, about: it is built by many
    /// threads.
    [[nodiscard]] uint64_t bytes() const;
    /// Embree's own scene, for measuring what bare traversal costs.
    [[nodiscard]] RTCSceneTy* native() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Makes denormals count as zero on the calling thread, as Embree wants it. Threads started
/// afterwards inherit it, so call it before the first use of a task library.
void flush_denormals();

}  // namespace petzval
