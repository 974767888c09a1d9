# The compiler settings every target shares, and one function for each kind of target.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_C_STANDARD 11)
set(CMAKE_C_STANDARD_REQUIRED ON)
set(CMAKE_C_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})

# A compiler cache wherever there is one. Paths below the project's folder count from there, so that another clone on
# the same machine finds what the first one compiled. Precompiled headers need the sloppiness: the times of the headers
# in them do not count, their texts do. Nor does the language of the compiler's messages.
find_program(GYROLOG_CCACHE ccache)
mark_as_advanced(GYROLOG_CCACHE)
if(GYROLOG_CCACHE)
  set(gyrolog_launcher ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=1
    CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime,locale ${GYROLOG_CCACHE})
  foreach(language C CXX)
    if(NOT DEFINED CMAKE_${language}_COMPILER_LAUNCHER)
      set(CMAKE_${language}_COMPILER_LAUNCHER ${gyrolog_launcher})
    endif()
  endforeach()
endif()

find_package(Threads REQUIRED)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)

add_library(gyrolog_settings INTERFACE)
# A simulated sample must be the same bits with both compilers: no contraction to fused multiply-add.
target_compile_options(gyrolog_settings INTERFACE -ffp-contract=off)
if(GYROLOG_WARNINGS)
  target_compile_options(gyrolog_settings INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wdouble-promotion -Wformat=2
    $<$<BOOL:${GYROLOG_WERROR}>:-Werror>
    $<$<COMPILE_LANGUAGE:CXX>:-Wold-style-cast -Woverloaded-virtual -Wnon-virtual-dtor>)
else()
  target_compile_options(gyrolog_settings INTERFACE -w)
endif()
# For the compiler cache: the text behind the preprocessor names the precompiled header.
target_compile_options(gyrolog_settings INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fpch-preprocess>)
target_include_directories(gyrolog_settings INTERFACE ${CMAKE_SOURCE_DIR})
target_link_libraries(gyrolog_settings INTERFACE Threads::Threads)
include(GyrologHardening)
if(GYROLOG_SANITIZE)
  target_compile_options(gyrolog_settings INTERFACE -fsanitize=${GYROLOG_SANITIZE} -fno-omit-frame-pointer
    -fno-sanitize-recover=all)
  if(GYROLOG_NO_SANITIZE)
    target_compile_options(gyrolog_settings INTERFACE -fno-sanitize=${GYROLOG_NO_SANITIZE})
  endif()
  if(GYROLOG_SANITIZE_IGNORELIST)
    target_compile_options(gyrolog_settings INTERFACE -fsanitize-ignorelist=${GYROLOG_SANITIZE_IGNORELIST})
  endif()
  target_link_options(gyrolog_settings INTERFACE -fsanitize=${GYROLOG_SANITIZE})
  # -Wmaybe-uninitialized misfires on instrumented code.
  target_compile_options(gyrolog_settings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
endif()
# Once for all folders: each search starts it.
if(GYROLOG_TESTS OR GYROLOG_BENCHMARKS OR GYROLOG_FUZZ OR GYROLOG_JOIN_SOURCES)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
endif()
if(GYROLOG_JOIN_SOURCES)
  # One source's local name is another's variable.
  target_compile_options(gyrolog_settings INTERFACE -Wno-shadow)
  # GCC looks through all its memory for what it can use again, from 128 MB on whenever it has doubled: a tenth of the
  # time that a long text takes, which needs most of its memory to its end. A quarter more memory instead.
  target_compile_options(gyrolog_settings INTERFACE
    $<$<COMPILE_LANG_AND_ID:CXX,GNU>:--param=ggc-min-heapsize=700000>)
endif()

# gyrolog_sources(NAME LINES [SEVERAL_PRECOMPILE <header>...] [REUSE target] SOURCES ...): the sources of a target. With
# GYROLOG_JOIN_SOURCES the end of the configuration (gyrolog_join_sources) makes of them fewer that include several each,
# LINES at most, which compile in half the time: for builds that are made once. Headers to precompile are those of REUSE,
# or its own where more than four sources are left.
function(gyrolog_sources name lines)
  cmake_parse_arguments(arg "" "REUSE" "SEVERAL_PRECOMPILE;SOURCES" ${ARGN})
  set(sources ${arg_SOURCES})
  list(TRANSFORM sources REPLACE "^([^/].*)$" "${CMAKE_CURRENT_SOURCE_DIR}/\\1")
  set_target_properties(${name} PROPERTIES GYROLOG_PRECOMPILE "${arg_SEVERAL_PRECOMPILE}" GYROLOG_REUSE "${arg_REUSE}")
  list(LENGTH sources count)
  if(GYROLOG_JOIN_SOURCES AND count GREATER 1)
    list(JOIN sources "\t" words)
    set_property(GLOBAL APPEND PROPERTY GYROLOG_TO_JOIN "${name}\t${lines}\t${words}")
  else()
    gyrolog_set_sources(${name} ${sources})
  endif()
endfunction()

function(gyrolog_set_sources name)
  target_sources(${name} PRIVATE ${ARGN})
  get_target_property(precompile ${name} GYROLOG_PRECOMPILE)
  get_target_property(reuse ${name} GYROLOG_REUSE)
  list(LENGTH ARGN units)
  # Headers take as long to precompile as three or four texts take to read them, and all of those would wait.
  if(precompile AND units GREATER 4)
    target_precompile_headers(${name} PRIVATE ${precompile})
  elseif(reuse AND NOT ARGN MATCHES "\\.c(;|$)")
    target_precompile_headers(${name} REUSE_FROM ${reuse})
  endif()
endfunction()

# One start of Python for all targets: a hundred take a minute.
function(gyrolog_join_sources)
  get_property(targets GLOBAL PROPERTY GYROLOG_TO_JOIN)
  if(NOT targets)
    return()
  endif()
  set(joined ${CMAKE_BINARY_DIR}/joined)
  list(JOIN targets "\n" lines)
  file(WRITE ${joined}/targets.txt "${lines}\n")
  execute_process(COMMAND ${Python3_EXECUTABLE} -B ${CMAKE_SOURCE_DIR}/tools/source_groups.py ${joined}
    OUTPUT_VARIABLE lines COMMAND_ERROR_IS_FATAL ANY OUTPUT_STRIP_TRAILING_WHITESPACE)
  string(REPLACE "\n" ";" lines "${lines}")
  foreach(line IN LISTS lines)
    string(REPLACE "\t" ";" line "${line}")
    gyrolog_set_sources(${line})
  endforeach()
endfunction()

# gyrolog_precompile_standard_headers(TARGET option...): the parts of the standard library that most sources include,
# read once for all of them.
function(gyrolog_precompile_standard_headers name)
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp CONTENT "" @ONLY)
  add_library(${name} STATIC ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE gyrolog_settings)
  target_compile_options(${name} PRIVATE ${ARGN})
  target_precompile_headers(${name} PRIVATE <algorithm> <array> <cmath> <cstdint> <functional> <limits> <map> <memory>
    <mutex> <numeric> <optional> <span> <string> <string_view> <utility> <vector>)
endfunction()
# What runs briefly need not be optimised for long. Instrumented, half the time to compile it goes into optimising.
if(GYROLOG_SANITIZE)
  set(GYROLOG_BRIEF_OPTIMIZATION -O0)
else()
  set(GYROLOG_BRIEF_OPTIMIZATION $<$<CONFIG:Release>:-O1>)
endif()
set(GYROLOG_STANDARD_HEADERS gyrolog_standard_headers)
gyrolog_precompile_standard_headers(${GYROLOG_STANDARD_HEADERS})
gyrolog_precompile_standard_headers(${GYROLOG_STANDARD_HEADERS}_brief ${GYROLOG_BRIEF_OPTIMIZATION})

# gyrolog_library(NAME SOURCES ... LINK ... [PRECOMPILE <header>...] [RUNS_BRIEFLY | FASTER_IN benchmark]): a static
# library with the project's settings. PRECOMPILE: headers that most of its sources include and that are long to read,
# in place of those of the standard library; where its sources are compiled as a few, those read them themselves.
# RUNS_BRIEFLY: nothing in it runs for long: GYROLOG_BRIEF_OPTIMIZATION is enough. FASTER_IN: -O3, which that benchmark
# shows to pay. Such a library reads no precompiled headers: they were compiled with -O2, and GCC 12 then compiles
# functions with a target attribute with -O2, too.
function(gyrolog_library name)
  cmake_parse_arguments(arg "RUNS_BRIEFLY" "FASTER_IN" "SOURCES;LINK;PRECOMPILE" ${ARGN})
  add_library(${name} STATIC)
  target_link_libraries(${name} PUBLIC ${arg_LINK} PRIVATE gyrolog_settings)
  target_include_directories(${name} PUBLIC ${CMAKE_SOURCE_DIR})
  set(precompiled ${GYROLOG_STANDARD_HEADERS})
  if(arg_RUNS_BRIEFLY)
    target_compile_options(${name} PRIVATE ${GYROLOG_BRIEF_OPTIMIZATION})
    set(precompiled ${GYROLOG_STANDARD_HEADERS}_brief)
  elseif(arg_FASTER_IN AND NOT GYROLOG_SANITIZE)
    target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O3>)
    set(precompiled "")
  endif()
  gyrolog_sources(${name} ${GYROLOG_JOINED_LINES} SEVERAL_PRECOMPILE ${arg_PRECOMPILE} REUSE "${precompiled}"
    SOURCES ${arg_SOURCES})
endfunction()

# Every test includes GoogleTest, most of them the same parts of the standard library: read once for all of them.
function(gyrolog_precompile_test_headers)
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/test_headers.cpp CONTENT "" @ONLY)
  add_library(gyrolog_test_headers STATIC ${CMAKE_CURRENT_BINARY_DIR}/test_headers.cpp)
  target_link_libraries(gyrolog_test_headers PRIVATE gyrolog_settings GTest::gmock)
  target_precompile_headers(gyrolog_test_headers PRIVATE <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream>
    <functional> <map> <memory> <numeric> <optional> <random> <sstream> <string> <vector> <gmock/gmock.h>
    <gtest/gtest.h> <nlohmann/json.hpp>)
endfunction()

# Programs that tests of the default tier run.
add_custom_target(default_tests)

# gyrolog_test(NAME SOURCES ... LINK ... [LABELS ...] [TIMEOUT seconds] [STATISTICS test...]): one GoogleTest binary, one
# ctest entry. COMPUTES: its own loops take long, and are optimised. STATISTICS: searches and statistics of many seconds,
# whose code the other tests run as well: an entry of their own, NAME_statistics, in the tier of that name.
function(gyrolog_test name)
  cmake_parse_arguments(arg "COMPUTES" "TIMEOUT" "SOURCES;LINK;LABELS;ENVIRONMENT;STATISTICS" ${ARGN})
  if(NOT GYROLOG_TESTS)
    return()
  endif()
  find_package(GTest REQUIRED)
  set(test_lines_joined 2000) # of tests, more have names in common
  add_executable(${name})
  target_link_libraries(${name} PRIVATE gyrolog_settings ${arg_LINK} GTest::gmock GTest::gtest_main)
  set(precompiled gyrolog_test_headers)
  if(arg_COMPUTES)
    target_compile_options(${name} PRIVATE -O2)
    set(precompiled "")
  endif()
  gyrolog_sources(${name} ${test_lines_joined} REUSE "${precompiled}" SOURCES ${arg_SOURCES})
  add_test(NAME ${name} COMMAND ${name})
  if(NOT arg_LABELS)
    set(arg_LABELS default)
  endif()
  # Instrumented, only the default tier is run: the others are not built.
  if("default" IN_LIST arg_LABELS)
    add_dependencies(default_tests ${name})
  elseif(GYROLOG_SANITIZE)
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
  endif()
  # Instrumented code is some ten times slower, and statistics take most of a minute on a machine that does nothing
  # else: a test that hangs is still found.
  set(statistics_timeout_s 600)
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 120)
    if(GYROLOG_SANITIZE)
      set(arg_TIMEOUT 1200)
    elseif("statistics" IN_LIST arg_LABELS)
      set(arg_TIMEOUT ${statistics_timeout_s})
    endif()
  endif()
  if(arg_STATISTICS)
    list(JOIN arg_STATISTICS ":" statistics)
    add_test(NAME ${name}_statistics COMMAND ${name} --gtest_filter=${statistics})
    gyrolog_test_settings(${name}_statistics statistics ${statistics_timeout_s} "${arg_ENVIRONMENT}")
    list(APPEND arg_ENVIRONMENT "GTEST_FILTER=-${statistics}")
  endif()
  gyrolog_test_settings(${name} "${arg_LABELS}" ${arg_TIMEOUT} "${arg_ENVIRONMENT}")
endfunction()

function(gyrolog_test_settings name labels timeout_s environment)
  set_tests_properties(${name} PROPERTIES LABELS "${labels}" TIMEOUT ${timeout_s} WORKING_DIRECTORY ${CMAKE_BINARY_DIR}
    ENVIRONMENT "GYROLOG_SOURCE_DIR=${CMAKE_SOURCE_DIR};GYROLOG_BUILD_DIR=${CMAKE_BINARY_DIR};${environment}")
endfunction()

# gyrolog_longer_test(NAME OF test TIMEOUT seconds ENVIRONMENT ... [ARGUMENTS ...]): the binary of another test once
# more in the long tier, with an environment that asks it for more.
function(gyrolog_longer_test name)
  cmake_parse_arguments(arg "" "OF;TIMEOUT" "ENVIRONMENT;ARGUMENTS" ${ARGN})
  if(GYROLOG_TESTS)
    add_test(NAME ${name} COMMAND ${arg_OF} ${arg_ARGUMENTS})
    gyrolog_test_settings(${name} long ${arg_TIMEOUT} "${arg_ENVIRONMENT}")
  endif()
endfunction()

# gyrolog_left_out(NAME REASON [LABELS ...]): in the place of a test that cannot be built here, an entry that ctest skips
# and tools/skipped_tests counts.
function(gyrolog_left_out name reason)
  cmake_parse_arguments(arg "" "" "LABELS" ${ARGN})
  if(NOT arg_LABELS)
    set(arg_LABELS default)
  endif()
  add_test(NAME ${name} COMMAND ${CMAKE_COMMAND} -E echo "skipped: ${reason}")
  set_tests_properties(${name} PROPERTIES LABELS "${arg_LABELS}" SKIP_REGULAR_EXPRESSION "^skipped: ")
endfunction()

# gyrolog_fuzz(NAME SOURCES ... LINK ...): with clang and GYROLOG_FUZZ a libFuzzer binary; in the ordinary build the
# same entry point behind a driver that feeds it a bounded number of generated inputs, as a default-tier test.
function(gyrolog_fuzz name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
  if(GYROLOG_FUZZ)
    add_executable(${name} ${arg_SOURCES})
    target_link_libraries(${name} PRIVATE gyrolog_settings ${arg_LINK})
    target_link_options(${name} PRIVATE -fsanitize=fuzzer)
  elseif(GYROLOG_TESTS)
    add_executable(${name} ${arg_SOURCES} ${CMAKE_SOURCE_DIR}/tests/fuzz/bounded_driver.cpp)
    target_link_libraries(${name} PRIVATE gyrolog_settings ${arg_LINK})
    add_test(NAME ${name} COMMAND ${name} ${CMAKE_SOURCE_DIR}/tests/fuzz/corpus/${name})
    set_tests_properties(${name} PROPERTIES LABELS "default;fuzz" TIMEOUT 120)
    add_dependencies(default_tests ${name})
  endif()
endfunction()

# gyrolog_benchmark(NAME SOURCES ... LINK ...): a Google Benchmark binary, built on request.
function(gyrolog_benchmark name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
  if(NOT GYROLOG_BENCHMARKS)
    return()
  endif()
  find_package(benchmark REQUIRED)
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE gyrolog_settings ${arg_LINK} benchmark::benchmark_main)
endfunction()
