// SPDX-License-Identifier: Apache-2.0
#include "io/picture/picture_budget.h"

#include <fmt/format.h>

#include "io/base/machine.h"

namespace petzval::io {
namespace {

std::string mebibytes(uint64_t bytes) {
    return fmt::format("{:.4g} MiB", static_cast<double>(bytes) * 0x1p-20);
}

}  // namespace

PictureBudget::PictureBudget() : PictureBudget(usable_memory_bytes() / 2) {}

std::string PictureBudget::take(uint64_t kept_bytes, uint64_t meanwhile_bytes) {
    const uint64_t needed_bytes = kept_bytes + meanwhile_bytes;
    if (needed_bytes <= left_bytes()) {
        taken_bytes_ += kept_bytes;
        return "";
    }
    return fmt::format(
        "needs {} once it is decoded; of the {} for pictures other pictures take {}; scale it "
        "down, or give more ⟨max-memory⟩",
        mebibytes(needed_bytes), mebibytes(limit_bytes_), mebibytes(taken_bytes_));
}

}  // namespace petzval::io
