// SPDX-License-Identifier: Apache-2.0
// Prints the size of a distant point's image:  spot LENS FIELD_DEG
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "image_size.h"

int main(int count, char** words) try {
    if (count != 3) return std::fputs("spot LENS FIELD_DEG\n", stderr), 2;
    std::puts(image_size(words[1], std::atof(words[2])).c_str());
    return 0;
} catch (const std::exception& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
}
