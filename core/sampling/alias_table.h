// SPDX-License-Identifier: Apache-2.0
// Alias table: draws one of many by weight, in constant time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace petzval {

/// Walker's alias method (Walker 1977, ACM Trans. Math. Softw. 3, 253), built as by Vose (1991,
/// IEEE Trans. Softw. Eng. 17, 972). Neighbouring u do not choose neighbouring things: what is
/// stratified in u is not so in what is chosen, which is why a Piecewise1D is the usual choice.
class AliasTable {
  public:
    AliasTable() = default;
    /// Weights must be finite and not negative, at least one above 0.
    explicit AliasTable(std::span<const float> weights);

    struct Draw {
        uint32_t cell;
        float offset;  ///< uniform in [0, 1) whatever the cell
    };
    /// Draws a cell; u in [0, 1).
    [[nodiscard]] Draw sample(float u) const;

  private:
    struct Slot {
        float own;       ///< share of the slot that is its own cell's
        uint32_t other;  ///< cell that has the rest
    };
    std::vector<Slot> slots_;
};

}  // namespace petzval
