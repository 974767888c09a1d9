# How a program that reads strangers' files is built: for every target that links gyrolog_settings.

# The loader finds Debian's libraries by itself. A path of the machine that built the program has no use elsewhere.
set(CMAKE_SKIP_RPATH ON)

# -fPIC for all: the program and libgyrolog-sensor are made of the same libraries. Hidden, so that the compiler may
# inline their functions, and so that the shared library exports what it declares and nothing else.
target_compile_options(gyrolog_settings INTERFACE -fPIC -fvisibility=hidden
  $<$<COMPILE_LANGUAGE:CXX>:-fvisibility-inlines-hidden>)

# Sanitizers bring their own checks, and the fortified functions would hide calls from them.
if(NOT GYROLOG_SANITIZE)
  target_compile_options(gyrolog_settings INTERFACE -fstack-protector-strong -fstack-clash-protection
    # Without the optimiser it does nothing but warn.
    $<$<CONFIG:Release,RelWithDebInfo,MinSizeRel>:-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2>)
  target_link_options(gyrolog_settings INTERFACE
    $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-pie> -Wl,-z,relro,-z,now,-z,noexecstack)
endif()
