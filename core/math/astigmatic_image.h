// SPDX-License-Identifier: Apache-2.0
// Images whose rays do not meet in a point.
#pragma once

#include "core/math/linear2.h"

namespace petzval {

/// Image of a lamp in a curved mirror or behind glass, as its rays have it: they meet in no point,
/// and it is longer than wide.
struct AstigmaticImage {
    V3f along, x, y;  ///< unit: mean direction of the rays, and across
    /// Where a ray passes the centre, along x and y, metres, by the x and y parts of its unit
    /// direction. To first order.
    Linear2f passes_m;
    /// Place on the image for a distance from there; within 1 is the lamp. 1/m.
    Linear2f place_per_m;
};

}  // namespace petzval
