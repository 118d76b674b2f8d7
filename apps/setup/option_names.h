// SPDX-License-Identifier: Apache-2.0
// The words that options and metadata have for the choices of a camera.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "apps/setup/camera_request.h"

namespace petzval {

template <class T>
using Words = std::vector<std::pair<std::string, T>>;

/// Every word of a choice; the argument only says which choice.
[[nodiscard]] inline Words<DispersionMode> words_of(DispersionMode) {
    return {{"tolerance", DispersionMode::Tolerance},
            {"shared", DispersionMode::Shared},
            {"split", DispersionMode::Split},
            {"single", DispersionMode::Single},
            {"hero", DispersionMode::Hero}};
}
[[nodiscard]] inline Words<ApertureScale> words_of(ApertureScale) {
    return {{"area", ApertureScale::EqualArea}, {"inscribed", ApertureScale::Inscribed}};
}
[[nodiscard]] inline Words<IrisSampling> words_of(IrisSampling) {
    return {{"formula", IrisSampling::Formula},
            {"rejection", IrisSampling::Rejection},
            {"triangles", IrisSampling::Triangles},
            {"alias", IrisSampling::Alias}};
}
[[nodiscard]] inline Words<Coating> words_of(Coating) {
    return {{"ideal", Coating::Ideal}, {"uncoated", Coating::Uncoated}, {"mgf2", Coating::MgF2}};
}
[[nodiscard]] inline Words<Precision> words_of(Precision) {
    return {{"float", Precision::Float}, {"double", Precision::Double}};
}
[[nodiscard]] inline Words<ExposureMode> words_of(ExposureMode) {
    return {{"normalised", ExposureMode::Normalised}, {"photographic", ExposureMode::Photographic}};
}
[[nodiscard]] inline Words<FocusBy> words_of(FocusBy) {
    return {{"paraxial", FocusBy::Paraxial}, {"traced", FocusBy::Traced}};
}
[[nodiscard]] inline Words<Fit> words_of(Fit) {
    return {{"lens", Fit::Lens}, {"fov", Fit::Fov}};
}

template <class T>
[[nodiscard]] std::string word_of(T value) {
    for (const auto& [word, choice] : words_of(value))
        if (choice == value) return word;
    return "";
}

}  // namespace petzval
