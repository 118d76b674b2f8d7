// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/camera/camera_report.h"

#include "apps/request/option_names.h"
#include "apps/request/parse.h"
#include "camera/lens/focus.h"
#include "io/base/format.h"

namespace petzval::apps {
namespace {

void describe_iris(const CameraReport& c, io::Metadata& m) {
    m.emplace_back("petzval:aperture", c.asked.aperture.value_or("circle"));
    m.emplace_back("petzval:apertureScale", name_of(c.asked.aperture_scale));
    if (c.asked.iris_sampling)
        m.emplace_back("petzval:irisSampling", name_of(*c.asked.iris_sampling));
    m.emplace_back("petzval:diffraction", name_of(c.asked.diffraction));
    m.emplace_back("petzval:exposureMode", name_of(c.asked.exposure));
    if (c.asked.exposure == ExposureMode::Photographic) {
        m.emplace_back("petzval:iso", c.asked.iso);
        m.emplace_back("petzval:shutter_s", c.asked.shutter_s);
    }
}

void describe_glass(const CameraReport& c, io::Metadata& m) {
    m.emplace_back("petzval:lens", c.lens);
    m.emplace_back("petzval:film_mm", static_cast<float>(c.film_mm));
    m.emplace_back("petzval:stopRadius_mm", static_cast<float>(c.stop_radius_mm));
    m.emplace_back("petzval:focusBy", name_of(c.asked.focus_by));
    m.emplace_back("petzval:coating", name_of(c.asked.coating));
    m.emplace_back("petzval:ghosts", name_of(c.asked.ghosts));
    m.emplace_back("petzval:lensPrecision", name_of(c.asked.precision));
    m.emplace_back("petzval:fit", name_of(c.asked.fit));
    m.emplace_back("petzval:dispersion", name_of(c.dispersion()));
}

}  // namespace

void describe_camera(const CameraReport& c, io::Metadata& m) {
    m.emplace_back("petzval:camera", c.name);
    m.emplace_back("petzval:cameraEye_m", io::with_commas(c.eye));
    m.emplace_back("petzval:cameraTarget_m", io::with_commas(c.target));
    if (c.asked.pose) m.emplace_back("petzval:cameraPose", text_of_pose(*c.asked.pose));
    if (c.asked.orbit_deg) m.emplace_back("petzval:orbit_deg", *c.asked.orbit_deg);
    if (c.orthographic) return;
    m.emplace_back("petzval:fov_deg", c.yfov_deg);
    m.emplace_back("petzval:focalLength_mm", c.focal_length_mm);
    m.emplace_back("petzval:sensorWidth_mm", c.sensor_mm.x);
    m.emplace_back("petzval:sensorHeight_mm", c.sensor_mm.y);
    m.emplace_back("petzval:lensRadius_m", c.lens_radius_m);
    if (c.natural_vignetting)
        m.emplace_back("petzval:naturalVignetting", *c.natural_vignetting ? "on" : "off");
    if (!c.lens.empty()) describe_glass(c, m);
    if (c.lens_radius_m <= 0) return;
    describe_iris(c, m);
    m.emplace_back("petzval:fstop", c.focal_length_mm * 1e-3f / (2 * c.lens_radius_m));
    m.emplace_back("petzval:fstopMeaning",
                   c.traced ? camera::kTracedFnumber : "focal length / diameter of the iris");
    m.emplace_back("petzval:focus_m", c.focus_m);
}

}  // namespace petzval::apps
