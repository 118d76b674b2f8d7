// SPDX-License-Identifier: Apache-2.0
// Embree 4 or 3, whichever is there: the calls that differ between them. CMakeLists.txt prefers 4
// as well.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace petzval::embree {

#if RTC_VERSION_MAJOR >= 4

/// What Embree hands to the filters of a call.
using Context = RTCRayQueryContext;
/// Scenes whose calls may bring a filter along.
inline constexpr RTCSceneFlags kFilterOfCall = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;

[[nodiscard]] inline Context new_context() {
    Context context;
    rtcInitRayQueryContext(&context);
    return context;
}

/// Finds the nearest hit that the filters of geometries and `also`, which may be null, let stand.
inline void intersect(RTCScene scene, Context& context, RTCFilterFunctionN also, RTCRayHit& query) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context;
    arguments.filter = also;
    if (also) arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    rtcIntersect1(scene, &query, &arguments);
}

/// Sets the length of a ray below 0 where something is on its way.
inline void occlude(RTCScene scene, Context& context, RTCRay& ray) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context;
    rtcOccluded1(scene, &ray, &arguments);
}

#else

using Context = RTCIntersectContext;
inline constexpr RTCSceneFlags kFilterOfCall = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;

[[nodiscard]] inline Context new_context() {
    Context context;
    rtcInitIntersectContext(&context);
    return context;
}

inline void intersect(RTCScene scene, Context& context, RTCFilterFunctionN also, RTCRayHit& query) {
    context.filter = also;
    rtcIntersect1(scene, &context, &query);
}

inline void occlude(RTCScene scene, Context& context, RTCRay& ray) {
    rtcOccluded1(scene, &context, &ray);
}

#endif

}  // namespace petzval::embree
