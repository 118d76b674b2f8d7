// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/lamps_in_view.h"

namespace petzval::apps {

bool shines_in(const SmallFeature& lamp, const camera::Pose& pose, const Bvh& bvh) {
    constexpr float kLeastCosine = 0.17f;  // light from 80 degrees and more hardly enters
    const V3f to = lamp.at_infinity ? lamp.centre : lamp.centre - pose.origin;
    const float away = to.length();
    if (!(away > lamp.radius_m) && !lamp.at_infinity) return false;
    Ray ray;
    ray.origin = pose.origin;
    ray.direction = to / away;
    if (!(-ray.direction.dot(pose.back) > kLeastCosine)) return false;
    if (!lamp.at_infinity) ray.t_max = away - 1.01f * lamp.radius_m;
    return !bvh.intersect(ray);
}

}  // namespace petzval::apps
