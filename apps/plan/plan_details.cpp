// SPDX-License-Identifier: Apache-2.0
#include "apps/plan/plan_details.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "apps/plan/displacement.h"
#include "apps/setup/ghosts.h"

namespace petzval::apps {
namespace {

/// Share of what a simpler model may err that floats may take: what they change is seldom more than
/// a millionth of it.
constexpr double kFloatShare = 1 / 4.;
constexpr uint32_t kRaysCompared = 64;
/// Ratio of efforts from which on the other choice is taken: they are known no better.
constexpr double kWorthIt = 0.95;

}  // namespace

std::optional<PrecisionFound> find_precision(const PlanRequest& request, const RenderSetup& first,
                                             const SceneRequest& chosen,
                                             integrator::TbbExecutor& executor) {
    if (!first.from.camera.traced || chosen.camera.precision == camera::Precision::Double)
        return std::nullopt;
    SceneRequest floats = chosen, doubles = chosen;
    // One ray for all wavelengths: what they are apart is no matter of precision.
    floats.camera.dispersion = doubles.camera.dispersion = camera::DispersionMode::Shared;
    floats.camera.ghosts = doubles.camera.ghosts = GhostUse::Off;
    doubles.camera.precision = camera::Precision::Double;
    const RenderSetup in_float = view_of(first, floats, executor),
                      in_double = view_of(first, doubles, executor);
    const V2i size = request.scene.size;
    const Displacement apart = displacement_of(
        {*in_float.view.still, in_float.view.observer},
        {*in_double.view.still, in_double.view.observer}, *first.prepared.scene,
        *first.prepared.bvh, first.from.camera.focus_plane(), size, kRaysCompared, true);
    const auto& squares = apart.square_px.values;
    const FilmMap most = most_error(apart, 0);
    const double mean = std::accumulate(most.values.begin(), most.values.end(), 0.) /
                        static_cast<double>(most.values.size());
    const double allowed = kFloatShare * kBiasShare * request.tolerance * request.tolerance;
    return PrecisionFound{mean <= allowed ? camera::Precision::Float : camera::Precision::Double,
                          std::sqrt(*std::max_element(squares.begin(), squares.end())), mean};
}

std::optional<LightsFound> find_lights(const PlanComparison& compared, const RenderSetup& first,
                                       const SceneRequest& chosen, size_t candidate) {
    if (first.prepared.scene->lights.size() < 2) return std::nullopt;
    SceneRequest other = chosen;
    other.light_choice = LightChoiceKind::Power;
    const auto effort = compared.effort_of(other, candidate);
    if (!effort) return std::nullopt;
    if (*effort < kWorthIt) return LightsFound{LightChoiceKind::Power, 1 / *effort};
    return LightsFound{LightChoiceKind::Tree, *effort};
}

GhostsFound find_ghosts(const PlanComparison& compared, const RenderSetup& first,
                        const SceneRequest& chosen, size_t candidate) {
    const Scene& scene = *first.prepared.scene;
    GhostsFound out{first.view.ghosts != nullptr,
                    lamps_into_lens(first.view, small_features_of(scene), *first.prepared.bvh),
                    {}};
    if (!out.shown) return out;
    SceneRequest alone = chosen;
    alone.camera.ghosts = GhostUse::Only;
    out.share = compared.light_of(alone, candidate);
    return out;
}

}  // namespace petzval::apps
