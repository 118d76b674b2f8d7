// SPDX-License-Identifier: Apache-2.0
// The glass catalogue in assets/glass.
#pragma once

#include <string>
#include <vector>

#include "core/spectrum/glass.h"

namespace petzval::io {

/// All glasses of the catalogue, in the order of the file. Takes a few ms. Throws InputError where
/// the program is not whole.
[[nodiscard]] std::vector<Glass> glass_catalog();

/// Up to five "maker:NAME" of the catalogue that look most like a text, the nearest first. The
/// maker may be missing or wrong.
[[nodiscard]] std::vector<std::string> glasses_near(const std::string& text);

}  // namespace petzval::io
