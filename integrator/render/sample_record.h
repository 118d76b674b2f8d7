// SPDX-License-Identifier: Apache-2.0
// Record of one sample: from a point of the film through the camera and along its paths.
#pragma once

#include <vector>

#include "camera/camera.h"
#include "integrator/path/path.h"
#include "integrator/render/render_job.h"

namespace petzval::integrator {

struct SampleRecord {
    V2f point_px{0.f};  ///< on the film, from the top left
    Bands bands;
    camera::LensLosses<uint32_t> lens;
    std::vector<camera::CameraPath> rays;  ///< those to targets last
    std::vector<PathEvent> events;         ///< path by path, one for each ray
    V4f film{0.f};                         ///< that the film gets: R, G, B in nits, alpha
    bool left_out = false;  ///< the film takes no such number: not finite, or too large

    /// Takes a sample as a render of the job does, bit for bit, and tells how it comes about.
    [[nodiscard]] static SampleRecord of(const Scene&, const Bvh&, const LightChoice&,
                                         const PathOptions&, const camera::Camera&,
                                         const RenderJob&, V2i frame_px, SampleId);
};

}  // namespace petzval::integrator
