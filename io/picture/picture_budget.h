// SPDX-License-Identifier: Apache-2.0
// Memory that decoded pictures may take: a small file may unpack to gigabytes.
#pragma once

#include <cstdint>
#include <string>

namespace petzval::io {

/// Budget that the pictures of a scene share. It is asked when a picture's header is known and
/// nothing is decoded yet.
class PictureBudget {
  public:
    /// Half of the memory that can be had: the other half is for the scene and the render.
    PictureBudget();
    explicit PictureBudget(uint64_t limit_bytes) : limit_bytes_(limit_bytes) {}

    /// Takes what is kept of a picture, where it and what decoding needs meanwhile are left.
    /// Returns the reason where they are not, else an empty text.
    [[nodiscard]] std::string take(uint64_t kept_bytes, uint64_t meanwhile_bytes);

    [[nodiscard]] uint64_t left_bytes() const { return limit_bytes_ - taken_bytes_; }

  private:
    uint64_t limit_bytes_, taken_bytes_ = 0;  ///< limit >= taken
};

}  // namespace petzval::io
