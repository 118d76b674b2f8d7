// SPDX-License-Identifier: Apache-2.0
#include "camera/setup/focused_lens.h"

#include <cmath>

#include "camera/lens/paraxial.h"

namespace petzval::camera {

std::optional<FocusedLens> focused_from_pupil(const Lens& filed, double distance_mm, FocusBy by,
                                              double stop_radius_mm) {
    constexpr int kRounds = 50;
    constexpr double kSettled_mm = 1e-6;
    const auto pupil_of = [](const Lens& lens) {
        return first_order(lens, kLineD_nm).entrance_pupil_mm;
    };
    const auto focus = [&](double pupil_mm, FocusBy how) {
        return focused(filed, pupil_mm - distance_mm, how, stop_radius_mm);
    };
    double pupil_mm = pupil_of(filed);
    auto lens = focus(pupil_mm, FocusBy::Paraxial);
    for (int i = 0; lens && i < kRounds && std::fabs(pupil_of(*lens) - pupil_mm) > kSettled_mm;
         ++i) {
        pupil_mm = pupil_of(*lens);
        lens = focus(pupil_mm, FocusBy::Paraxial);
    }
    if (lens && by == FocusBy::Traced) lens = focus(pupil_mm, by);
    if (!lens) return std::nullopt;
    pupil_mm = pupil_of(*lens);
    return FocusedLens{*std::move(lens), pupil_mm};
}

}  // namespace petzval::camera
