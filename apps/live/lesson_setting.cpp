// SPDX-License-Identifier: Apache-2.0
#include "apps/live/lesson_setting.h"

#include "apps/request/value_error.h"
#include "camera/bench/analysis.h"
#include "camera/bench/ray_path.h"
#include "camera/lens/focus.h"

namespace petzval::apps {

LessonSetting::LessonSetting(const CameraRequest& camera)
    : model_(choose_camera_model(camera, {}, io::FileScope::Anywhere, {}, 1.5f)) {}

double LessonSetting::focus_mm() const {
    const auto* set = asked().focus ? std::get_if<FocusDistance>(&*asked().focus) : nullptr;
    if (!set) throw ValueError("⟨focus⟩", "must be a distance here");
    return 1000 * double(set->m);
}

double LessonSetting::fstop() const {
    if (!asked().fstop) throw ValueError("⟨fstop⟩", "is needed here");
    return double(*asked().fstop);
}

io::ArgumentError LessonSetting::refusal(const std::string& why) const {
    return {asked().lens.value_or("⟨lens⟩"), "", why};
}

camera::LensBench LessonSetting::bench(bool stopped) const {
    const auto* loaded = std::get_if<LoadedLens>(&model_.optics);
    if (!loaded) throw refusal("is no lens that is traced surface by surface");
    const camera::Prescription& file = loaded->lens.prescription();
    const camera::Lens open(file);
    const auto narrow = stopped ? camera::stopped_down(open, fstop()) : std::nullopt;
    return in_focus(narrow ? camera::Lens(*narrow) : open);
}

camera::LensBench LessonSetting::in_focus(const camera::Lens& lens) const {
    auto out = camera::LensBench::focused(lens, focus_mm());
    if (!out) throw refusal("forms no image at that distance");
    return *std::move(out);
}

camera::AimedBundle LessonSetting::rays(const camera::LensBench& bench, double height_mm,
                                        double distance_mm, double nm) const {
    const camera::Section section = height_mm > 0 ? camera::Section::X : camera::Section::Y;
    const auto field_deg =
        height_mm > 0 ? camera::field_of_height_deg(*bench.lens, height_mm, bench.film_mm, section)
                      : 0.;
    if (field_deg)
        if (auto out =
                camera::AimedBundle::aim(*bench.lens, {*field_deg, distance_mm, section}, nm))
            return *std::move(out);
    throw refusal("lets no light through there");
}

camera::Singlet LessonSetting::singlet() const {
    constexpr float kUsualFocal_mm = 50;
    const auto* one = std::get_if<SingleLens>(&model_.optics);
    if (!one) throw refusal("is no singlet:GLASS");
    if (one->radii_mm) return {one->glass, (*one->radii_mm)[0], (*one->radii_mm)[1]};
    return camera::Singlet::bent(
        one->glass, double(asked().focal_length_mm.value_or(kUsualFocal_mm)), one->bending);
}

LessonJson rays_about_film(const camera::LensBench& bench, const camera::AimedBundle& bundle,
                           int count, double behind_mm) {
    LessonJson paths = LessonJson::array();
    for (const camera::PupilPoint& point : camera::section_points(bundle, count)) {
        paths.push_back(LessonJson::array());
        for (auto [z, y] :
             camera::ray_path(*bench.lens, bundle, point, bench.film_mm + behind_mm, 0))
            paths.back().push_back({z - bench.film_mm, y});
    }
    return paths;
}

}  // namespace petzval::apps
