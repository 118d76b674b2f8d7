// SPDX-License-Identifier: Apache-2.0
// Path tracer: estimates the radiance that arrives along a ray.
#pragma once

#include <concepts>
#include <optional>
#include <vector>

#include "core/film/film.h"
#include "core/light/light_choice.h"
#include "core/light/light_sampling.h"
#include "core/traversal/bvh.h"
#include "integrator/path/path_options.h"
#include "integrator/path/path_state.h"
#include "integrator/path/watch.h"

namespace petzval::integrator {

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

/// Camera ray that a path begins with, and what its camera says of it.
struct PathStart {
    Ray ray;
    m4 lanes{-1, -1, -1, -1};  ///< bands that share the ray; the others get 0
    /// The ray depends on which lane is the hero (Bands::hero), which must then decide nothing
    /// else.
    bool hero_decided = true;
    /// Chance, above 0, that the path goes on from where it is scattered far and wide; then it
    /// counts 1 / chance times.
    float continue_probability = 1;
    bool fills_layers = false;  ///< the sample's layers are wanted, of all lanes
    bool fills_guide = false;   ///< likewise its guide of a denoiser
};

/// Watch: Unwatched, or one that has its functions (watch.h).
template <RayCaster Caster = Bvh, class Watch = Unwatched>
class PathTracer {
  public:
    /// Scene, caster and lights must outlive the tracer.
    PathTracer(const Scene& scene, const Caster& caster, const LightChoice& lights,
               const PathOptions& options, Watch watch = {})
        : scene_(scene), caster_(caster), lights_(lights), options_(options), watch_(watch) {}

    /// Estimate of the radiance that arrives along a camera ray, in its lanes. The sample's alpha
    /// and layers are filled in on the way. Pure but for the counts and records.
    [[nodiscard]] f4 radiance(const PathStart&, const Bands&, const Sampler&, FilmSample&,
                              PathStats&) const;

  private:
    enum class Step : uint8_t { Arrived, GoOn, End };
    struct FoundLight;
    struct DrawnLight;
    struct Scattering;
    struct Onward;

    // path_steps.h
    [[nodiscard]] PathState begun(const PathStart&, const Bands&, const Sampler&, PathStats&) const;
    [[nodiscard]] std::optional<Hit> next_hit(PathState&) const;
    [[nodiscard]] Step advance_to_surface(PathState&, Arrival&) const;
    [[nodiscard]] std::optional<Onward> scatter(PathState&, const Scattering&,
                                                const Sampler::VertexNumbers&) const;
    [[nodiscard]] bool survives(PathState&, float u) const;
    static void leave(PathState&, const Scattering&, const Onward&);
    // found_light.h
    void add_background(PathState&, FilmSample&) const;
    [[nodiscard]] f4 visible_background(const PathState&, FilmSample&) const;
    [[nodiscard]] FoundLight sky_light(const PathState&) const;
    [[nodiscard]] FoundLight sun_discs(const PathState&) const;
    [[nodiscard]] FoundLight emitted(const PathState&, const Surface&, const ShadingInput&) const;
    // sampled_light.h
    [[nodiscard]] std::optional<DrawnLight> draw_light(const PathState&, const LightReceiver&,
                                                       const Sampler::VertexNumbers&) const;
    [[nodiscard]] f4 sampled_light(const PathState&, const Scattering&,
                                   const std::optional<DrawnLight>&) const;
    [[nodiscard]] f4 light_on_smooth(const PathState&, const Scattering&, const DrawnLight&) const;
    [[nodiscard]] f4 direct_light(const PathState&, const Scattering&, const DrawnLight&) const;

    const Scene& scene_;
    const Caster& caster_;
    const LightChoice& lights_;
    PathOptions options_;
    [[no_unique_address]] Watch watch_;
};

extern template class PathTracer<Bvh>;

}  // namespace petzval::integrator
