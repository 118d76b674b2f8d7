// SPDX-License-Identifier: Apache-2.0
// Asks the processor for what the program is built for, before any of that runs: this file is built
// for every x86-64 processor.
#include <cpuid.h>
#include <unistd.h>

#include <cstring>

namespace {

void say(const char* text) {
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, std::strlen(text));
}

// Before the constructors of other files.
[[gnu::constructor(101)]] void require_processor() {
    __builtin_cpu_init();
    bool lacks = false;
    const auto need = [&lacks](bool has, const char* name) {
        if (has) return;
        say(lacks ? ", " : "petzval: this processor lacks ");
        say(name);
        lacks = true;
    };
    // What x86-64-v3 has beyond the levels before it (x86-64 psABI, 2020, table 3.1).
    need(__builtin_cpu_supports("avx"), "AVX");
    need(__builtin_cpu_supports("avx2"), "AVX2");
    need(__builtin_cpu_supports("bmi"), "BMI1");
    need(__builtin_cpu_supports("bmi2"), "BMI2");
    need(__builtin_cpu_supports("fma"), "FMA");
    // Compilers have no names for these, or only new ones: AMD 2024, "APM volume 3", appendix E.
    unsigned a = 0, b = 0, basic = 0, extended = 0, d = 0;
    __get_cpuid(1, &a, &b, &basic, &d);
    __get_cpuid(0x80000001, &a, &b, &extended, &d);
    need((basic >> 29 & 1) != 0, "F16C");
    need((extended >> 5 & 1) != 0, "LZCNT");
    need((basic >> 22 & 1) != 0, "MOVBE");
    if (!lacks) return;
    say("; Petzval needs " PETZVAL_PROCESSOR
        ", as Intel has it since Haswell (2013) and AMD since Excavator (2015)\n");
    ::_exit(1);
}

}  // namespace
