// SPDX-License-Identifier: Apache-2.0
// The one name of each choice: options, metadata and reports all take it from here.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "apps/setup/request.h"
#include "core/sampling/filter.h"
#include "core/sampling/sampler.h"

namespace petzval {

template <class T>
struct OptionName {
    std::string_view name;
    T value;
};

/// Every name of a choice, an array of OptionName<T>.
template <class T>
inline constexpr int kOptionNames = 0;

template <>
inline constexpr std::array kOptionNames<DispersionMode>{
    OptionName<DispersionMode>{"tolerance", DispersionMode::Tolerance},
    OptionName<DispersionMode>{"shared", DispersionMode::Shared},
    OptionName<DispersionMode>{"split", DispersionMode::Split},
    OptionName<DispersionMode>{"single", DispersionMode::Single},
    OptionName<DispersionMode>{"hero", DispersionMode::Hero}};
template <>
inline constexpr std::array kOptionNames<ApertureScale>{
    OptionName<ApertureScale>{"area", ApertureScale::EqualArea},
    OptionName<ApertureScale>{"inscribed", ApertureScale::Inscribed}};
template <>
inline constexpr std::array kOptionNames<IrisSampling>{
    OptionName<IrisSampling>{"formula", IrisSampling::Formula},
    OptionName<IrisSampling>{"rejection", IrisSampling::Rejection},
    OptionName<IrisSampling>{"triangles", IrisSampling::Triangles},
    OptionName<IrisSampling>{"alias", IrisSampling::Alias}};
template <>
inline constexpr std::array kOptionNames<Coating>{
    OptionName<Coating>{"ideal", Coating::Ideal},
    OptionName<Coating>{"uncoated", Coating::Uncoated}, OptionName<Coating>{"mgf2", Coating::MgF2}};
template <>
inline constexpr std::array kOptionNames<Precision>{
    OptionName<Precision>{"float", Precision::Float},
    OptionName<Precision>{"double", Precision::Double}};
template <>
inline constexpr std::array kOptionNames<ExposureMode>{
    OptionName<ExposureMode>{"normalised", ExposureMode::Normalised},
    OptionName<ExposureMode>{"photographic", ExposureMode::Photographic}};
template <>
inline constexpr std::array kOptionNames<FocusBy>{
    OptionName<FocusBy>{"paraxial", FocusBy::Paraxial},
    OptionName<FocusBy>{"traced", FocusBy::Traced}};
template <>
inline constexpr std::array kOptionNames<Fit>{OptionName<Fit>{"lens", Fit::Lens},
                                              OptionName<Fit>{"fov", Fit::Fov}};
template <>
inline constexpr std::array kOptionNames<SpectralMode>{
    OptionName<SpectralMode>{"auto", SpectralMode::Auto},
    OptionName<SpectralMode>{"rgb", SpectralMode::Rgb},
    OptionName<SpectralMode>{"wavelengths", SpectralMode::Wavelengths}};
template <>
inline constexpr std::array kOptionNames<WhiteBalance>{
    OptionName<WhiteBalance>{"none", WhiteBalance::None},
    OptionName<WhiteBalance>{"illuminant", WhiteBalance::Illuminant}};
template <>
inline constexpr std::array kOptionNames<SamplerKind>{
    OptionName<SamplerKind>{"owen", SamplerKind::Owen},
    OptionName<SamplerKind>{"sobol", SamplerKind::Sobol},
    OptionName<SamplerKind>{"independent", SamplerKind::Independent}};
template <>
inline constexpr std::array kOptionNames<FilterKind>{
    OptionName<FilterKind>{"box", FilterKind::Box},
    OptionName<FilterKind>{"gauss", FilterKind::Gauss},
    OptionName<FilterKind>{"blackman-harris", FilterKind::BlackmanHarris}};
template <>
inline constexpr std::array kOptionNames<LightChoiceKind>{
    OptionName<LightChoiceKind>{"tree", LightChoiceKind::Tree},
    OptionName<LightChoiceKind>{"power", LightChoiceKind::Power},
    OptionName<LightChoiceKind>{"uniform", LightChoiceKind::Uniform}};
template <>
inline constexpr std::array kOptionNames<Traversal>{
    OptionName<Traversal>{"robust", Traversal::Robust},
    OptionName<Traversal>{"fast", Traversal::Fast}};

/// Text of a distance as --focus takes it.
[[nodiscard]] inline std::string focus_text(FocusDistance distance) {
    return std::isinf(distance.m) ? "infinity" : fmt::format("{}", distance.m);
}

/// The name of a choice.
template <class T>
[[nodiscard]] std::string name_of(T value) {
    for (const auto& [name, choice] : kOptionNames<T>)
        if (choice == value) return std::string(name);
    return "";
}

}  // namespace petzval
