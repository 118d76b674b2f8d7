// SPDX-License-Identifier: Apache-2.0
#include "io/develop.h"

#include <fmt/format.h>

#include "core/colour.h"

namespace petzval {
namespace {

const char* name_of(SamplerKind kind) {
    switch (kind) {
        case SamplerKind::Owen:
            return "owen";
        case SamplerKind::Sobol:
            return "sobol";
        case SamplerKind::Independent:
            return "independent";
    }
    return "";
}

const char* name_of(FilterKind kind) {
    switch (kind) {
        case FilterKind::Box:
            return "box";
        case FilterKind::Gauss:
            return "gauss";
        case FilterKind::BlackmanHarris:
            return "blackman-harris";
    }
    return "";
}

std::string numbers(const V3f& v) {
    return fmt::format("{:.9g},{:.9g},{:.9g}", v.x, v.y, v.z);
}

void describe_camera(const CameraReport& c, Picture& picture) {
    auto& m = picture.metadata;
    m.emplace_back("petzval:camera", c.name);
    m.emplace_back("petzval:cameraEye_m", numbers(c.eye));
    m.emplace_back("petzval:cameraTarget_m", numbers(c.target));
    if (c.orthographic) return;
    m.emplace_back("petzval:fov_deg", c.yfov_deg);
    m.emplace_back("petzval:focalLength_mm", c.focal_length_mm);
    m.emplace_back("petzval:sensorWidth_mm", c.sensor_width_mm);
    m.emplace_back("petzval:sensorHeight_mm", c.sensor_height_mm);
    m.emplace_back("petzval:lensRadius_m", c.lens_radius_m);
    if (c.lens_radius_m <= 0) return;
    m.emplace_back("petzval:fstop", c.focal_length_mm * 1e-3f / (2 * c.lens_radius_m));
    m.emplace_back("petzval:focus_m", c.focus_m);
}

}  // namespace

std::string program_version() {
    return "petzval " PETZVAL_VERSION;
}

Picture develop(const Film& film, const Session& session, const RenderJob& job,
                const PathOptions& options, uint32_t end_sample) {
    const Rect crop = film.crop();
    Picture picture;
    picture.width = crop.width();
    picture.height = crop.height();
    picture.x = crop.x0;
    picture.y = crop.y0;
    picture.full_width = film.full_size().x;
    picture.full_height = film.full_size().y;
    picture.channels = {"R", "G", "B", "A"};
    for (const Aov aov : film.aovs()) {
        const AovInfo& info = aov_info(aov);
        for (int i = 0; i < info.channel_count; ++i)
            picture.channels.emplace_back(info.channels[i]);
    }
    picture.pixels.reserve(picture.channels.size() * static_cast<size_t>(picture.width) *
                           picture.height);
    for (int y = crop.y0; y < crop.y1; ++y) {
        for (int x = crop.x0; x < crop.x1; ++x) {
            const V4f colour = film.colour(x, y);
            for (int i = 0; i < 4; ++i) picture.pixels.push_back(colour[i]);
            for (size_t layer = 0; layer < film.aovs().size(); ++layer) {
                const V3f value = film.aov(x, y, layer);
                for (int i = 0; i < aov_info(film.aovs()[layer]).channel_count; ++i)
                    picture.pixels.push_back(value[i]);
            }
        }
    }

    auto& m = picture.metadata;
    m.emplace_back("Software", program_version());
    m.emplace_back("petzval:sceneHash", fmt::format("{:016x}", session.scene_hash));
    m.emplace_back("petzval:samples", fmt::format("{}:{}", job.first_sample, end_sample));
    m.emplace_back("petzval:seed", fmt::format("{}", job.seed));
    m.emplace_back("petzval:sampler", name_of(job.sampler));
    m.emplace_back("petzval:filter", name_of(job.filter.kind()));
    m.emplace_back("petzval:filterRadius_px", job.filter.radius_px());
    m.emplace_back("petzval:maxDepth", options.max_depth);
    m.emplace_back("petzval:scale", "RGB 1 = 1 nit of D65 white");
    m.emplace_back("petzval:luminousEfficacy_lm_per_W", kLuminousEfficacy_lm_per_w);
    describe_camera(session.camera_report, picture);
    return picture;
}

}  // namespace petzval
