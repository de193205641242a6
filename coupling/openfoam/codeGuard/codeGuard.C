/*---------------------------------------------------------------------------*\
codeGuard: no code of a case. Copyright (C) 2025 the sdph authors.
This program is free software: you can redistribute it and/or modify it under
the terms of the GNU General Public License as published by the Free Software
Foundation, either version 3 of the License, or (at your option) any later
version. It comes WITHOUT ANY WARRANTY; see <http://www.gnu.org/licenses/>.
\*---------------------------------------------------------------------------*/
// Loaded before the programs that sdph starts on a case (LD_PRELOAD). OpenFOAM's library calls dlopen for nothing but what
// a case names (libs and its like, compiled code); that ends the program. Others, such as MPI, load what they need.

#include <cstdio>
#include <cstring>
#include <dlfcn.h>
#include <unistd.h>

extern "C" void* dlopen(const char* file, int mode) noexcept
{
    using Function = void* (*)(const char*, int);
    static const Function next = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "dlopen"));
    Dl_info caller;
    if (dladdr(__builtin_return_address(0), &caller) && std::strstr(caller.dli_fname, "libOpenFOAM."))
    {
        std::fflush(nullptr);
        std::fprintf(stderr, "\n--> FOAM FATAL ERROR: the case loads the library %s; give --allow-code if it is yours\n\n", file);
        _exit(1);
    }
    return next(file, mode);
}
