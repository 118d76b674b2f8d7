// SPDX-License-Identifier: Apache-2.0
// The colour space that an image file says its colours are in.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace petzval::io::codec {

/// Colour space of a PNG by its chunks, in words; empty where it is sRGB, or nothing is said. cICP
/// comes before iCCP, that before sRGB, and that before gAMA and cHRM (PNG, third edition, section
/// 4.3). profile: its ICC profile, or nothing.
[[nodiscard]] std::string other_space_of_png(std::span<const uint8_t> file,
                                             std::span<const uint8_t> profile);

/// Colour space of an ICC profile likewise; an empty one says nothing. By its primaries and its
/// curve, not by its name. ICC.1:2022, sections 7 and 10.
[[nodiscard]] std::string other_space_of_profile(std::span<const uint8_t> profile);

}  // namespace petzval::io::codec
