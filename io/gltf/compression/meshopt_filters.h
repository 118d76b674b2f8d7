// SPDX-License-Identifier: Apache-2.0
// The filters of KHR_meshopt_compression (appendix B), in place. They are our own because the
// library's takes approximate square roots (RSQRTPS), which differ between makers of processors.
#pragma once

#include <cstdint>
#include <span>

namespace petzval::io {

/// Decodes unit vectors of four signed bytes each: octahedral coordinates (Cigolle et al. 2014), 1
/// in their scale, and a byte that stays.
void filter_octahedral_8(std::span<uint8_t> elements);

/// Decodes unit vectors of four 16-bit integers each, likewise.
void filter_octahedral_16(std::span<uint8_t> elements);

/// Decodes unit quaternions of four 16-bit integers each: the three smaller components, then 1 in
/// their scale with the place of the greatest one in its two lowest bits.
void filter_quaternion(std::span<uint8_t> elements);

/// Decodes floats: 8 bits of exponent, 24 of mantissa, both signed.
void filter_exponential(std::span<uint8_t> elements);

/// Decodes colours of four bytes each: luma, two signed chromas (YCoCg, Malvar and Sullivan 2003)
/// and alpha, whose highest bit that is set tells how many bits the others have.
void filter_color_8(std::span<uint8_t> elements);

/// Decodes colours of four 16-bit integers each, likewise.
void filter_color_16(std::span<uint8_t> elements);

}  // namespace petzval::io
