# How a program that reads strangers' files is built: for every target that links gyrolog_settings.

# The loader finds Debian's libraries by itself. A path of the machine that built the program has no use elsewhere.
set(CMAKE_SKIP_RPATH ON)

# Sanitizers bring their own checks, and the fortified functions would hide calls from them.
if(NOT GYROLOG_SANITIZE)
  # -fPIE for the libraries, too: no shared library is made of them, and -fPIC, which CMake has for libraries, keeps
  # the compiler from inlining their functions.
  target_compile_options(gyrolog_settings INTERFACE -fPIE -fstack-protector-strong -fstack-clash-protection
    # Without the optimiser it does nothing but warn.
    $<$<CONFIG:Release,RelWithDebInfo,MinSizeRel>:-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2>)
  target_link_options(gyrolog_settings INTERFACE -pie -Wl,-z,relro,-z,now,-z,noexecstack)
endif()
