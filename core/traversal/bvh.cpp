// SPDX-License-Identifier: Apache-2.0
// Rays through the hierarchy: what they pass on their way, and what they meet.
#include <pmmintrin.h>

#include <algorithm>

#include "core/traversal/barycentric.h"
#include "core/traversal/bvh_filters.h"
#include "core/traversal/bvh_impl.h"

namespace petzval {

uint32_t instance_of(uint32_t inst_id, uint32_t geom_id) {
    return inst_id != RTC_INVALID_GEOMETRY_ID ? inst_id : geom_id;
}

namespace {

// Notes a hit and goes on. Embree's own coordinates are left out, as barycentric() finds them.
void note(const RTCFilterFunctionNArguments* args) {
    if (args->valid[0] != -1) return;
    const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
    const auto& context = static_cast<AllContext&>(*reinterpret_cast<FilteredRay*>(args->context));
    context.all->push_back(
        {V2f(0.f), instance_of(hit.instID[0], hit.geomID), hit.primID, context.ray->time});
    args->valid[0] = 0;
}

// Lets rays pass backs. Ray and normal are in one space, whose mirroring changes no front into a
// back: glTF turns the winding of what is mirrored.
void pass_back(const RTCFilterFunctionNArguments* args) {
    if (args->valid[0] != -1) return;
    const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
    const auto& ray = *reinterpret_cast<const RTCRay*>(args->ray);
    if (ray.dir_x * hit.Ng_x + ray.dir_y * hit.Ng_y + ray.dir_z * hit.Ng_z >= 0.f)
        args->valid[0] = 0;
}

RTCRay to_embree(const Ray& r, float t_min = 0) {
    RTCRay ray;
    ray.org_x = r.origin.x, ray.org_y = r.origin.y, ray.org_z = r.origin.z;
    ray.dir_x = r.direction.x, ray.dir_y = r.direction.y, ray.dir_z = r.direction.z;
    // tnear above 0: in a plane through the origin of an axis nothing rounds, so that no offset
    // moves a ray off it, and it would meet at 0 what it leaves.
    ray.tnear = std::max(std::numeric_limits<float>::min(), t_min), ray.tfar = r.t_max;
    ray.time = r.time, ray.mask = ~0u, ray.id = 0, ray.flags = 0;
    return ray;
}

ShadowContext of_shadow(const Ray& r) {
    return {{embree::new_context(), &r}, nullptr, false, false};
}

// Whether Embree can trace a ray: Debian's ends the program on others, with a bound of 1.844e18 for
// every coordinate.
bool traceable(const Ray& r) {
    const f4 bound = splat(1.8e18f);
    const V3f &o = r.origin, &d = r.direction;
    const f4 first{o.x, o.y, o.z, d.x}, last{o.z, d.x, d.y, d.z};
    const m4 within = (first <= bound) & (first >= -bound) & (last <= bound) & (last >= -bound);
    const m4 pairs = within & __builtin_shufflevector(within, within, 2, 3, 0, 1);
    return (pairs[0] & pairs[1]) != 0 && r.t_max >= 0.f;
}

}  // namespace

[[gnu::always_inline]] inline std::optional<Hit> Bvh::Impl::nearest(
    const Ray& r, float t_min, RTCFilterFunctionN also, const PassedBlends* passed) const {
    if (!traceable(r)) return std::nullopt;
    NearestContext context{{embree::new_context(), &r}, passed};
    RTCRayHit query;
    query.ray = to_embree(r, t_min);
    query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree::intersect(top, context.of_embree, also, query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    // Not Embree's own coordinates: they come from an approximate reciprocal, of which
    // processors of different makers have different ones.
    const uint32_t instance = instance_of(query.hit.instID[0], query.hit.geomID);
    const uint32_t triangle = query.hit.primID;
    return Hit{barycentric(scene, instance, triangle, r), instance, triangle, r.time};
}

bool Bvh::Impl::is_met(const Ray& r, embree::Context& context) const {
    RTCRay ray = to_embree(r);
    embree::occlude(top, context, ray);
    return ray.tfar < 0.f;
}

std::optional<Hit> Bvh::intersect(const Ray& r, const PassedBlends* passed) const {
    if (!passed) return impl_->nearest(r, 0.f, nullptr, nullptr);
    return impl_->nearest(r, passed->t_min, nullptr, passed);
}

std::optional<Hit> Bvh::intersect_front(const Ray& r, float t_min,
                                        const PassedBlends* passed) const {
    return impl_->nearest(r, t_min, pass_back, passed);
}

bool Bvh::occluded(const Ray& r) const {
    ShadowContext context = of_shadow(r);
    return traceable(r) && impl_->is_met(r, context.of_embree);
}

Passage Bvh::passage(const Ray& r) const {
    if (!traceable(r)) return {1.f, false};
    ShadowContext context = of_shadow(r);
    if (!impl_->has_blends) {
        const bool met = impl_->is_met(r, context.of_embree);
        return {met ? 0.f : 1.f, context.panes};
    }
    PassedBlends blends;
    context.blends = &blends;
    if (impl_->is_met(r, context.of_embree)) return {0.f, context.panes};
    float left = 1.f;
    if (context.too_many) {
        context.blends = nullptr;
        left = impl_->is_met(r, context.of_embree) ? 0.f : 1.f;
    } else if (blends.count > 0) {
        const auto begin = blends.passed.begin(), end = begin + blends.count;
        const auto place = [](const auto& p) { return std::pair(p.instance, p.triangle); };
        std::sort(begin, end, [&](auto& a, auto& b) { return place(a) < place(b); });
        for (auto p = begin; p != end; ++p) left *= p->left;
    }
    return {left, context.panes};
}

std::vector<Hit> Bvh::all_hits(const Ray& r) const {
    std::vector<Hit> hits;
    if (!traceable(r) || impl_->scene.volume_boxes.empty()) return hits;
    AllContext context{{{embree::new_context(), &r}, nullptr}, &hits};
    RTCRayHit query;
    query.ray = to_embree(r);
    query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree::intersect(impl_->top, context.of_embree, note, query);
    const auto place = [](const Hit& h) { return std::pair(h.instance, h.triangle); };
    std::sort(hits.begin(), hits.end(),
              [&](const Hit& a, const Hit& b) { return place(a) < place(b); });
    const auto same = [&](const Hit& a, const Hit& b) { return place(a) == place(b); };
    hits.erase(std::unique(hits.begin(), hits.end(), same), hits.end());
    for (Hit& h : hits) h.barycentric = barycentric(impl_->scene, h.instance, h.triangle, r);
    return hits;
}

bool Bvh::has_cutouts() const {
    return impl_->has_cutouts;
}

bool Bvh::has_blends() const {
    return impl_->has_blends;
}

uint64_t Bvh::bytes() const {
    return static_cast<uint64_t>(std::max<int64_t>(impl_->bytes, 0));
}

RTCSceneTy* Bvh::native() const {
    return impl_->top;
}

void flush_denormals() {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
}

}  // namespace petzval
