// SPDX-License-Identifier: Apache-2.0
// Readers of one number, for CLI11's transform().
#pragma once

#include <cstdint>
#include <span>

#include "apps/request/quantity.h"

namespace CLI {
class Validator;
}

namespace petzval::apps {

/// Reader of a number as parse_number() takes it. Leaves a plain number in the first unit, as "0.3"
/// for "30cm".
[[nodiscard]] CLI::Validator number_between(double least, double most,
                                            std::span<const Unit> units = {});
/// Reader of a whole number as parse_whole_number() takes it.
[[nodiscard]] CLI::Validator whole_number_between(uint64_t least, uint64_t most);

}  // namespace petzval::apps
