// SPDX-License-Identifier: Apache-2.0
// Prescription: a lens as its designer wrote it down.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "camera/lens/layer_stack.h"
#include "core/spectrum/glass.h"

namespace petzval::camera {

enum class Profile : uint8_t {
    Rotational,
    CylinderX,  ///< axis along x: power in the y-z section
    CylinderY   ///< axis along y: power in the x-z section
};

/// Surface of sag c r^2 / (1 + sqrt(1 - (1 + k) c^2 r^2)) + sum A r^n; r is |y| or |x| for a
/// cylinder.
struct LensSurface {
    double curvature_1_mm = 0;  ///< > 0: the centre lies on the sensor's side; 0: plane
    double conic = 0;           ///< k
    std::vector<std::array<double, 2>> asphere;  ///< {n, A}, A in mm^(1-n)
    Profile profile = Profile::Rotational;
    double thickness_mm = 0;  ///< to the next vertex; of the last surface: to the film
    double semi_diameter_mm = 0;
    bool stop = false;                     ///< the plane of the iris; glass does not change there
    std::optional<Glass> glass;            ///< medium behind the surface; air where there is none
    SurfaceCoat coat = Coating::Uncoated;  ///< not Filed
};

/// Lens in millimetres. Light travels towards +z, from the scene to the sensor; z = 0 at the first
/// vertex.
struct Prescription {
    std::string name, title, source;
    int year = 0;                       ///< of the design; 0: not known
    std::vector<LensSurface> surfaces;  ///< at least one; exactly one is the stop
    double image_circle_mm = 0;         ///< diameter
    std::optional<double> stated_focal_length_mm, stated_fnumber, stated_field_half_deg;
    /// Surfaces first to last (from 0, both ends included) that move to focus; all where absent.
    std::optional<std::array<int, 2>> focus_group;
};

}  // namespace petzval::camera
