// SPDX-License-Identifier: Apache-2.0
#include "apps/live/lesson_setting.h"

#include "apps/request/value_error.h"
#include "camera/bench/analysis.h"
#include "camera/bench/ray_path.h"
#include "camera/lens/focus.h"

namespace petzval {

LessonSetting::LessonSetting(const CameraRequest& camera)
    : model_(choose_camera_model(camera, {}, FileScope::Anywhere, {}, 1.5f)) {}

double LessonSetting::focus_mm() const {
    const auto* set = asked().focus ? std::get_if<FocusDistance>(&*asked().focus) : nullptr;
    if (!set) throw ValueError("⟨focus⟩", "must be a distance here");
    return 1000 * double(set->m);
}

double LessonSetting::fstop() const {
    if (!asked().fstop) throw ValueError("⟨fstop⟩", "is needed here");
    return double(*asked().fstop);
}

ArgumentError LessonSetting::refusal(const std::string& why) const {
    return {asked().lens.value_or("⟨lens⟩"), "", why};
}

LensBench LessonSetting::bench(bool stopped) const {
    const auto* loaded = std::get_if<LoadedLens>(&model_.optics);
    if (!loaded) throw refusal("is no lens that is traced surface by surface");
    const Prescription& file = loaded->lens.prescription();
    const Lens open(file);
    const auto narrow = stopped ? stopped_down(open, fstop()) : std::nullopt;
    return in_focus(narrow ? Lens(*narrow) : open);
}

LensBench LessonSetting::in_focus(const Lens& lens) const {
    auto out = LensBench::focused(lens, focus_mm());
    if (!out) throw refusal("forms no image at that distance");
    return *std::move(out);
}

AimedBundle LessonSetting::rays(const LensBench& bench, double height_mm, double distance_mm,
                                double nm) const {
    const Section section = height_mm > 0 ? Section::X : Section::Y;
    const auto field_deg =
        height_mm > 0 ? field_of_height_deg(*bench.lens, height_mm, bench.film_mm, section) : 0.;
    if (field_deg)
        if (auto out = AimedBundle::aim(*bench.lens, {*field_deg, distance_mm, section}, nm))
            return *std::move(out);
    throw refusal("lets no light through there");
}

Singlet LessonSetting::singlet() const {
    constexpr float kUsualFocal_mm = 50;
    const auto* one = std::get_if<SingleLens>(&model_.optics);
    if (!one) throw refusal("is no singlet:GLASS");
    if (one->radii_mm) return {one->glass, (*one->radii_mm)[0], (*one->radii_mm)[1]};
    return Singlet::bent(one->glass, double(asked().focal_length_mm.value_or(kUsualFocal_mm)),
                         one->bending);
}

LessonJson rays_about_film(const LensBench& bench, const AimedBundle& bundle, int count,
                           double behind_mm) {
    LessonJson paths = LessonJson::array();
    for (const PupilPoint& point : section_points(bundle, count)) {
        paths.push_back(LessonJson::array());
        for (auto [z, y] : ray_path(*bench.lens, bundle, point, bench.film_mm + behind_mm, 0))
            paths.back().push_back({z - bench.film_mm, y});
    }
    return paths;
}

}  // namespace petzval
