// SPDX-License-Identifier: Apache-2.0
// Path tracer: estimates the radiance that arrives along a ray.
#pragma once

#include <concepts>
#include <optional>
#include <vector>

#include "core/film/film.h"
#include "core/light/light_choice.h"
#include "core/sampling/sampler.h"
#include "core/scene/scene.h"
#include "core/shading/surface.h"
#include "core/traversal/bvh.h"
#include "integrator/path/path_options.h"
#include "integrator/path/stats.h"

namespace petzval {

/// Ray caster for paths: Bvh, or a test's own.
template <class T>
concept RayCaster = requires(const T t, const Ray& r, const PassedBlends* passed) {
    { t.intersect(r, passed) } -> std::same_as<std::optional<Hit>>;
    { t.intersect_front(r, float(), passed) } -> std::same_as<std::optional<Hit>>;
    { t.passage(r) } -> std::same_as<Passage>;
    { t.has_cutouts() } -> std::same_as<bool>;
    { t.has_blends() } -> std::same_as<bool>;
    { t.all_hits(r) } -> std::same_as<std::vector<Hit>>;
};

template <RayCaster Caster = Bvh>
class PathTracer {
  public:
    /// Scene, caster and lights must outlive the tracer.
    PathTracer(const Scene& scene, const Caster& caster, const LightChoice& lights,
               const PathOptions& options)
        : scene_(scene), caster_(caster), lights_(lights), options_(options) {}

    /// Estimate of the radiance that arrives along a camera ray, in `lanes` of the bands, 0 in the
    /// others. The sample's alpha and layers are filled in on the way; aovs: layers are wanted, of
    /// all lanes. led: the ray depends on which lane leads. rest: chance, above 0, that a path goes
    /// on from where it is scattered far and wide; then it counts 1 / rest times. Pure but for the
    /// counts.
    [[nodiscard]] f4 radiance(const Ray&, const Bands&, const Sampler&, bool aovs, FilmSample&,
                              PathStats&, m4 lanes = m4{-1, -1, -1, -1}, bool led = true,
                              float rest = 1.f) const;

  private:
    struct Vertex;
    struct Scattering;
    struct DrawnLight;
    [[nodiscard]] f4 visible_background(const Ray&, const Bands&, FilmSample&) const;
    [[nodiscard]] f4 escaped(const Ray&, const Bands&, const Vertex& last,
                             ChanceFinds& by_chance) const;
    [[nodiscard]] f4 sun_discs(const Ray&, const Bands&, const Vertex& last, bool in_view,
                               ChanceFinds&) const;
    [[nodiscard]] f4 emitted(const Surface&, Rgb, const Bands&, const Vertex& last) const;
    [[nodiscard]] std::optional<DrawnLight> draw_light(const LightReceiver&,
                                                       const Sampler::VertexNumbers&, const Bands&,
                                                       float time) const;
    [[nodiscard]] f4 light_on_smooth(const Scattering&, const DrawnLight&) const;
    [[nodiscard]] f4 direct_light(const Scattering&, const DrawnLight&) const;

    const Scene& scene_;
    const Caster& caster_;
    const LightChoice& lights_;
    PathOptions options_;
};

extern template class PathTracer<Bvh>;

}  // namespace petzval
