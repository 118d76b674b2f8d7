// SPDX-License-Identifier: Apache-2.0
#include "camera/ghosts/ghost_draws.h"

#include <utility>

#include "camera/ray_bundle.h"

namespace petzval::camera {
namespace {

/// Shares of the samples that draw over all, and through a region: a ghost is darker than the
/// picture, and changes slowly over it.
constexpr float kOverAll = 0.125f, kThroughRegion = 0.25f;
/// Share of the draws over all whose pair is chosen by the lamps: where their regions miss
/// something, no draw is much too seldom.
constexpr float kByLamps = 0.4f;

}  // namespace

GhostDraws::GhostDraws(GhostOptics optics, GhostRegions regions, const RunTasks& run)
    : optics_(std::move(optics)), pupils_(optics_, run), regions_(std::move(regions)) {}

bool GhostDraws::are_of(const GhostOptics& other) const {
    const LensCamera &camera = optics_.camera(), &of_other = other.camera();
    return camera.input().coating == of_other.input().coating && optics_.pairs() == other.pairs() &&
           has_same_rays(camera, of_other);
}

auto GhostDraws::draw(V2f film_mm, float wave, const Sampler& sampler) const -> OfSample {
    OfSample out;
    const float through = sampler.get1(Dim::GhostPick) / kThroughRegion,
                over_all = sampler.get1(Dim::GhostPick, 1) / kOverAll;
    if (through < 1)
        out.through_region = regions_.draw(film_mm, wave, through, sampler.get2(Dim::GhostPoint));
    if (!(over_all < 1)) return out;
    const bool by_lamps = regions_.serve(film_mm) && over_all < kByLamps;
    const float pick = by_lamps                  ? over_all / kByLamps
                       : regions_.serve(film_mm) ? (over_all - kByLamps) / (1 - kByLamps)
                                                 : over_all;
    const uint32_t pair = by_lamps ? regions_.pair(film_mm, pick) : pupils_.pair(pick);
    out.over_all =
        GhostDraw{pair, pupils_.point_mm(pair, film_mm, sampler.get2(Dim::GhostPoint, 1))};
    return out;
}

float GhostDraws::density(V2f film_mm, std::span<const float> waves, const GhostDraw& draw) const {
    const float by_lamps = regions_.serve(film_mm) ? kByLamps : 0.f;
    const float chance =
        by_lamps * regions_.chance(film_mm, draw.pair) + (1 - by_lamps) * pupils_.chance(draw.pair);
    float through = 0;
    for (const float wave : waves) through += regions_.density(film_mm, wave, draw);
    return kOverAll * chance * pupils_.density(film_mm, draw) +
           kThroughRegion * through / static_cast<float>(waves.size());
}

}  // namespace petzval::camera
