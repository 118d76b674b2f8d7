// SPDX-License-Identifier: Apache-2.0
// Ray inside a lens, its status, and its hit at each surface.
#pragma once

#include "camera/lens/number.h"

namespace petzval::camera {

enum class Towards { Film, Scene };
/// Whether semi-diameters stop light; the iris has one as well.
enum class Clip { Yes, No };
/// Outcome of a ray. Each surface tests in this order: missed, vignetted, totally reflected.
enum class RayStatus : int { Passed, Vignetted, TotallyReflected, Missed };

/// Surfaces to trace through, both included, first on the scene's side whatever the direction;
/// nothing is done where last < first.
struct SurfaceRange {
    int first = 0, last = 0;
};

/// Ray in a lens, millimetres. The direction has unit length (in floats within 1e-6, less where
/// light grazes a surface) and says where light is followed to, z towards the film. z of the origin
/// counts from the vertex of the last surface that was met, so that no digits are lost on the
/// length of the lens.
///
/// Lanes that are blocked keep their status, and go on along the axis, where nothing can go wrong.
template <class N>
struct LensRay {
    Vec3<N> origin, direction;
    int counted_from = 0;     ///< surface from whose vertex z of the origin counts
    CodeOf<N> status_code{};  ///< RayStatus, as a number
    CodeOf<N> end_surface{};  ///< surface at which a blocked lane ended

    [[nodiscard]] MaskOf<N> alive() const { return status_code == 0; }
    [[nodiscard]] RayStatus status(int i) const { return RayStatus(lane(status_code, i)); }
};

/// Hit of a ray on a surface, as an observer is told: before refraction, without derivatives.
template <class V>
struct LensHit {
    int surface;
    Vec3<V> point;      ///< counted from this surface's vertex
    V distance_mm;      ///< from the point before
    V cosine;           ///< of incidence, 0 to 1
    V index;            ///< of the medium on the way
    MaskOf<V> reached;  ///< lanes for which the above is true: blocked here at most
};

struct NoObserver {
    void operator()(const auto&...) const {}
};

}  // namespace petzval::camera
