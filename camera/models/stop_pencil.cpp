// SPDX-License-Identifier: Apache-2.0
#include "camera/models/stop_pencil.h"

namespace petzval::camera {

V3d StopPencil::direction(V2d s) const {
    const V2d slope = tangents - s * vergence_per_m(s.length());
    return {slope.x, slope.y, -1};
}

}  // namespace petzval::camera
