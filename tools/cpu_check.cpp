// Says in words that this processor is too old, instead of dying of an illegal instruction. It is
// compiled for the oldest x86-64 and runs before any other code of the program, for even the start
// of main may use what is missing.
#include <unistd.h>

#include <cstring>

#include "tools/exit_code.h"

namespace {

// Plain calls of the system only: no library of ours or of C++ has been set up yet.
void say(const char* text)
{
    if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) ::_exit(scree::kExitInternal);
}

__attribute__((constructor(101))) void requireProcessorFeatures()
{
    __builtin_cpu_init();
    const bool isSufficient = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                              __builtin_cpu_supports("bmi2");
    if (isSufficient) return;
    say("Error: scree needs a processor with AVX2, FMA and BMI2 (Intel since 2013, AMD since "
        "2015); "
        "this one lacks:");
    if (!__builtin_cpu_supports("avx2")) say(" AVX2");
    if (!__builtin_cpu_supports("fma")) say(" FMA");
    if (!__builtin_cpu_supports("bmi2")) say(" BMI2");
    say("\n");
    ::_exit(scree::kExitInternal);
}

}  // namespace
