// SPDX-License-Identifier: Apache-2.0
// The one name of each choice: options, metadata and reports all take it from here.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "apps/request/render_order.h"
#include "core/sampling/filter.h"
#include "core/sampling/sampler.h"

namespace petzval::apps {

template <class T>
struct OptionName {
    std::string_view name;
    T value;
};

/// Every name of a choice, an array of OptionName<T>.
template <class T>
inline constexpr int kOptionNames = 0;

template <>
inline constexpr auto kOptionNames<camera::DispersionMode> =
    std::to_array<OptionName<camera::DispersionMode>>({{"shared", camera::DispersionMode::Shared},
                                                       {"hero", camera::DispersionMode::Hero},
                                                       {"split", camera::DispersionMode::Split}});
template <>
inline constexpr auto kOptionNames<camera::ApertureScale> =
    std::to_array<OptionName<camera::ApertureScale>>({{"area", camera::ApertureScale::EqualArea},
                                                      {"inscribed",
                                                       camera::ApertureScale::Inscribed}});
template <>
inline constexpr auto kOptionNames<camera::IrisSampling> =
    std::to_array<OptionName<camera::IrisSampling>>({{"formula", camera::IrisSampling::Formula},
                                                     {"rejection", camera::IrisSampling::Rejection},
                                                     {"triangles", camera::IrisSampling::Triangles},
                                                     {"alias", camera::IrisSampling::Alias}});
template <>
inline constexpr auto kOptionNames<camera::Coating> = [] {
    std::array<OptionName<camera::Coating>, camera::kCoatingNames.size()> names{};
    for (size_t i = 0; i < names.size(); ++i)
        names[i] = {camera::kCoatingNames[i].first, camera::kCoatingNames[i].second};
    return names;
}();
template <>
inline constexpr auto kOptionNames<camera::Precision> =
    std::to_array<OptionName<camera::Precision>>({{"float", camera::Precision::Float},
                                                  {"double", camera::Precision::Double}});
template <>
inline constexpr auto kOptionNames<ExposureMode> = std::to_array<OptionName<ExposureMode>>(
    {{"normalised", ExposureMode::Normalised}, {"photographic", ExposureMode::Photographic}});
template <>
inline constexpr auto kOptionNames<camera::FocusBy> = std::to_array<OptionName<camera::FocusBy>>(
    {{"paraxial", camera::FocusBy::Paraxial}, {"traced", camera::FocusBy::Traced}});
template <>
inline constexpr auto kOptionNames<Fit> = std::to_array<OptionName<Fit>>({{"lens", Fit::Lens},
                                                                          {"fov", Fit::Fov}});
template <>
inline constexpr auto kOptionNames<DiffractionUse> = std::to_array<OptionName<DiffractionUse>>(
    {{"off", DiffractionUse::Off}, {"auto", DiffractionUse::Auto}});
template <>
inline constexpr auto kOptionNames<GhostUse> = std::to_array<OptionName<GhostUse>>(
    {{"auto", GhostUse::Auto}, {"off", GhostUse::Off}, {"only", GhostUse::Only}});
template <>
inline constexpr auto kOptionNames<SpectralMode> =
    std::to_array<OptionName<SpectralMode>>({{"auto", SpectralMode::Auto},
                                             {"rgb", SpectralMode::Rgb},
                                             {"wavelengths", SpectralMode::Wavelengths}});
template <>
inline constexpr auto kOptionNames<WhiteBalance> = std::to_array<OptionName<WhiteBalance>>(
    {{"none", WhiteBalance::None}, {"illuminant", WhiteBalance::Illuminant}});
template <>
inline constexpr auto kOptionNames<SamplerKind> =
    std::to_array<OptionName<SamplerKind>>({{"owen", SamplerKind::Owen},
                                            {"sobol", SamplerKind::Sobol},
                                            {"independent", SamplerKind::Independent}});
template <>
inline constexpr auto kOptionNames<FilterKind> =
    std::to_array<OptionName<FilterKind>>({{"box", FilterKind::Box},
                                           {"gauss", FilterKind::Gauss},
                                           {"blackman-harris", FilterKind::BlackmanHarris}});
template <>
inline constexpr auto kOptionNames<LightChoiceKind> =
    std::to_array<OptionName<LightChoiceKind>>({{"tree", LightChoiceKind::Tree},
                                                {"power", LightChoiceKind::Power},
                                                {"uniform", LightChoiceKind::Uniform}});
template <>
inline constexpr auto kOptionNames<TargetUse> =
    std::to_array<OptionName<TargetUse>>({{"auto", TargetUse::Auto}, {"off", TargetUse::Off}});
template <>
inline constexpr auto kOptionNames<Traversal> = std::to_array<OptionName<Traversal>>(
    {{"robust", Traversal::Robust}, {"fast", Traversal::Fast}});

template <>
inline constexpr auto kOptionNames<ProgressStyle> =
    std::to_array<OptionName<ProgressStyle>>({{"auto", ProgressStyle::Auto},
                                              {"bar", ProgressStyle::Bar},
                                              {"lines", ProgressStyle::Lines},
                                              {"json", ProgressStyle::Json},
                                              {"percent", ProgressStyle::Percent},
                                              {"none", ProgressStyle::None}});

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

}  // namespace petzval::apps
