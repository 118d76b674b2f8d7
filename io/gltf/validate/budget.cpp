// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/validate/budget.h"

#include <fmt/format.h>

namespace petzval::io {
namespace {

constexpr uint64_t free_bytes = uint64_t(256) << 20;
constexpr uint64_t times_owned = 16, times_decoded = 2;
// Draco's best: about a byte and a half for a triangle of 36 bytes, vertices included.
constexpr uint64_t times_compressed = 32;

}  // namespace

void GltfBudget::ask(uint64_t bytes, const JsonCursor& place) {
    const uint64_t limit = free_bytes + times_owned * owned_ + times_decoded * decoded_;
    if (bytes > limit || asked_ > limit - bytes)
        place.fail(
            fmt::format("asks for {} MiB, too much for a file that holds {} MiB; "
                        "store the data in the file",
                        (bytes >> 20) + (asked_ >> 20), owned_ >> 20));
    asked_ += bytes;
}

uint64_t GltfBudget::left_to_decode() const {
    return free_bytes + times_compressed * owned_ - decoded_;
}

void GltfBudget::ask_decoded(uint64_t bytes, const JsonCursor& place) {
    if (bytes > left_to_decode())
        place.fail(
            fmt::format("would be decoded to {} MiB, too much for a file that holds {} MiB; "
                        "export it without compression",
                        (bytes >> 20) + (decoded_ >> 20), owned_ >> 20));
    decoded_ += bytes;
}

}  // namespace petzval::io
