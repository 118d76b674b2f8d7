// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

/// Size of a distant point's image, in words. Throws std::exception where there is none.
std::string image_size(const std::string& lens, double field_deg);
