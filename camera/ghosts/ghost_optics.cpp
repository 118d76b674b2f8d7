// SPDX-License-Identifier: Apache-2.0
#include "camera/ghosts/ghost_optics.h"

#include <algorithm>
#include <array>

#include "camera/ghosts/lens_face.h"
#include "core/spectrum/glass.h"

namespace petzval::camera {
namespace {

constexpr std::array<double, 4> kVisible_nm{450, 517, 583, 650};

std::vector<GhostPair> pairs_of(const Lens& lens, const std::optional<CoatTables>& tables) {
    std::vector<GhostPair> out;
    if (!tables) return out;
    const LensCoats& coats = tables->coats();
    for (int first = 1; first < lens.size(); ++first)
        for (int second = 0; second < first; ++second)
            if (!coats.ideal(first) && !coats.ideal(second)) out.push_back({first, second});
    return out;
}

}  // namespace

GhostOptics::GhostOptics(std::shared_ptr<const LensCamera> camera)
    : camera_(std::move(camera)),
      pairs_(pairs_of(lens(), camera_->optics().coats())),
      rear_mm_(lens().prescription().surfaces.back().semi_diameter_mm) {}

float GhostOptics::rear_mm2() const {
    return kPi * static_cast<float>(rear_mm_ * rear_mm_);
}

std::optional<GhostRay> GhostOptics::ray(GhostPair pair, V2f film_mm, V2f rear_mm,
                                         const LensIndices<f4>& indices, f4 nm, m4 lanes) const {
    const auto face = face_point(lens(), lens().last(), V2d(rear_mm));
    if (!face) return {};
    const V3d from(double(film_mm.x), double(film_mm.y),
                   camera_->input().film_mm - lens().vertex_mm(lens().last()));
    const V3d way = face->point_mm - from;
    const double length = way.length();
    const V3d d = way / length;
    const double cosine_at_lens = -d.dot(face->normal);
    if (!(cosine_at_lens > 0) || !(d.z < 0)) return {};
    GhostRay out;
    out.sr_per_mm2 = static_cast<float>(-d.z * cosine_at_lens / (face->normal.z * length * length));
    const auto all_lanes = [](const V3d& v) {
        return Vec3<f4>{splat(float(v.x)), splat(float(v.y)), splat(float(v.z))};
    };
    // From the surface itself, where floats have the most digits.
    LensRay<f4> start;
    start.counted_from = lens().last();
    start.origin = all_lanes(face->point_mm);
    start.direction = all_lanes(d);
    f4 open = zero_off(lanes, splat(1.f));
    std::vector<CoatHit> hits;
    hits.reserve(3 * size_t(lens().size()));
    const int stop = lens().stop();
    const auto observe = [&](const LensHit<f4>& hit, const GhostStep& step) {
        hits.push_back({hit.surface, step.passage.towards, step.mirrors, hit.cosine, hit.index});
        if (hit.surface != stop) return;
        for (int i = 0; i < 4; ++i)
            if (open[i] > 0)
                open[i] *= camera_->optics().transmits({hit.point.x[i], hit.point.y[i]});
    };
    out.ray = start;
    const m4 passed =
        trace_ghost<f4>(lens(), pair, Towards::Scene, Clip::Yes, indices, out.ray, observe);
    out.share = zero_off(passed, open);
    if (!any(out.share > 0.f)) return {};
    for (const CoatHit& hit : hits) out.share *= coat_share(hit, indices, nm);
    return out;
}

// Light takes the way of the ray from the scene: the one that is traced here backwards.
f4 GhostOptics::coat_share(const CoatHit& hit, const LensIndices<f4>& indices, f4 nm) const {
    const auto& s = lens().surfaces<float>()[size_t(hit.surface)];
    if (s.medium_before == s.medium_after) return splat(1.f);
    const f4& into =
        indices.of_medium[hit.towards == Towards::Film ? s.medium_after : s.medium_before];
    if (!hit.mirrors) return tables().transmittance(hit.surface, {hit.index, into, hit.cosine}, nm);
    f4 out{};
    for (int i = 0; i < 4; ++i)
        out[i] = i > 0 && nm[i] == nm[i - 1] && hit.cosine[i] == hit.cosine[i - 1]
                     ? out[i - 1]
                     : float(tables()
                                 .coats()
                                 .at(hit.surface, hit.towards,
                                     {double(hit.index[i]), double(into[i]), double(hit.cosine[i]),
                                      double(nm[i])})
                                 .reflected);
    return out;
}

float GhostOptics::reflects(GhostPair pair) const {
    const auto along_axis = [&](int surface, double nm) {
        const auto& s = lens().surfaces<double>()[size_t(surface)];
        return tables()
            .coats()
            .at(surface, Towards::Film,
                {lens().media()[s.medium_before].index(nm),
                 lens().media()[s.medium_after].index(nm), 1, nm})
            .reflected;
    };
    double sum = 0;
    for (const double nm : kVisible_nm)
        sum += along_axis(pair.first, nm) * along_axis(pair.second, nm);
    return static_cast<float>(sum / kVisible_nm.size());
}

}  // namespace petzval::camera
