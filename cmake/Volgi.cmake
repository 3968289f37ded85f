# What every target of the house shares: language, warnings, sanitizers, where programs go, how a room becomes a library.
include(GNUInstallDirs)

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
find_program(VOLGI_CCACHE ccache)
if(VOLGI_CCACHE)
  # The sloppiness that precompiled headers need (ccache's manual, "Precompiled headers").
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
    CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${VOLGI_CCACHE})
endif()

add_library(volgi_options INTERFACE)
add_library(volgi::options ALIAS volgi_options)
set_target_properties(volgi_options PROPERTIES EXPORT_NAME options)
target_compile_features(volgi_options INTERFACE cxx_std_20)
# No contraction: CPU results must not depend on which instructions the compiler fuses (docs/conventions.md#numbers).
target_compile_options(volgi_options INTERFACE $<BUILD_INTERFACE:-Wall;-Wextra;-Wshadow;-Wconversion;-Wno-sign-conversion;-ffp-contract=off>)
if(VOLGI_WERROR)
  target_compile_options(volgi_options INTERFACE $<BUILD_INTERFACE:-Werror>)
endif()
if(VOLGI_SANITIZE)
  target_compile_options(volgi_options INTERFACE $<BUILD_INTERFACE:-fsanitize=address,undefined;-fno-sanitize-recover=all;-fno-omit-frame-pointer>)
  target_link_options(volgi_options INTERFACE $<BUILD_INTERFACE:-fsanitize=address,undefined>)
endif()
if(VOLGI_TSAN)
  # No fences in ThreadSanitizer (GCC's -Wtsan); what is ordered by them alone would be reported.
  target_compile_options(volgi_options INTERFACE $<BUILD_INTERFACE:-fsanitize=thread;-fno-omit-frame-pointer;-Wno-tsan>)
  target_link_options(volgi_options INTERFACE $<BUILD_INTERFACE:-fsanitize=thread>)
endif()
if(VOLGI_FUZZ)
  # The libraries of others are built without: no types of theirs for `vptr`, no signatures for `function`.
  set(sanitizers -fsanitize=address,undefined -fno-sanitize=vptr,function)
  target_compile_options(volgi_options INTERFACE -fsanitize=fuzzer-no-link ${sanitizers} -fno-sanitize-recover=all
    -fno-omit-frame-pointer)
  target_link_options(volgi_options INTERFACE ${sanitizers})
endif()
target_compile_definitions(volgi_options INTERFACE GLM_FORCE_DEPTH_ZERO_TO_ONE GLM_ENABLE_EXPERIMENTAL)

# Precompiled headers: what nearly every file reads, once for each kind of target, since a kind's flags have to be the same.
# Sources with options of their own are compiled without. CMAKE_DISABLE_PRECOMPILE_HEADERS turns them off (preset tidy:
# clang cannot read GCC's), and every file has to compile without them all the same.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  target_compile_options(volgi_options INTERFACE $<BUILD_INTERFACE:-fpch-preprocess>)  # for ccache
endif()
set(VOLGI_COMMON_HEADERS <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <map> <memory> <optional> <span>
  <string> <string_view> <utility> <vector> <fmt/format.h> <glm/glm.hpp> <glm/gtc/constants.hpp>)
file(CONFIGURE OUTPUT precompiled.cpp CONTENT "// Precompiled headers need a source.\n")
# volgi_precompiled(NAME HEADERS... LIBS...): target NAME, for volgi_use_precompiled.
function(volgi_precompiled name)
  cmake_parse_arguments(P "" "" "HEADERS;LIBS" ${ARGN})
  add_library(${name} OBJECT ${PROJECT_BINARY_DIR}/precompiled.cpp)
  target_link_libraries(${name} PRIVATE volgi_options ${P_LIBS})
  target_precompile_headers(${name} PRIVATE ${VOLGI_COMMON_HEADERS} ${P_HEADERS})
endfunction()
# volgi_use_precompiled_later(TARGET NAME): at the folder's end, when sources have their options.
function(volgi_use_precompiled_later target name)
  cmake_language(EVAL CODE "cmake_language(DEFER CALL volgi_use_precompiled ${target} ${name})")
endfunction()
function(volgi_use_precompiled target name)
  target_precompile_headers(${target} REUSE_FROM ${name})
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    get_source_file_property(own_options ${source} TARGET_DIRECTORY ${target} COMPILE_OPTIONS)
    if(own_options)
      set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
    endif()
  endforeach()
endfunction()

volgi_precompiled(volgi_room_precompiled LIBS glm::glm fmt::fmt)

# volgi_room(NAME SOURCES... PUBLIC libs... PRIVATE libs...): static library volgi_NAME, alias volgi::NAME.
function(volgi_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(volgi_${name} STATIC ${ROOM_SOURCES})
  add_library(volgi::${name} ALIAS volgi_${name})
  set_target_properties(volgi_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(volgi_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/volgi>)
  target_link_libraries(volgi_${name} PUBLIC volgi_options ${ROOM_PUBLIC} PRIVATE ${ROOM_PRIVATE})
  volgi_use_precompiled_later(volgi_${name} volgi_room_precompiled)
  set_property(GLOBAL APPEND PROPERTY VOLGI_TARGETS volgi_${name})
endfunction()

# volgi_install_program(TARGET): into bin/. The package that brings its libraries (cmake/Package.cmake) has them in
# lib/volgi; they are found there, and theirs in turn, which DT_RUNPATH would not do.
function(volgi_install_program program)
  set_target_properties(${program} PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}/volgi")
  target_link_options(${program} PRIVATE -Wl,--disable-new-dtags)
  install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs)
endfunction()

# volgi_discover_suites(PROGRAM PREFIX PROPERTIES [FILTER googletest's]): ctest's entries for a GoogleTest program, one for
# a suite (DiscoverSuites.cmake).
function(volgi_discover_suites program prefix properties)
  cmake_parse_arguments(T "" "FILTER" "" ${ARGN})
  string(REGEX REPLACE "[^A-Za-z0-9_]" "" name ${prefix})
  set(entries ${CMAKE_CURRENT_BINARY_DIR}/${name}_entries.cmake)
  add_custom_command(TARGET ${program} POST_BUILD BYPRODUCTS ${entries}
    COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${program}> -DPREFIX=${prefix} "-DFILTER=${T_FILTER}" -DMOST=12
      "-DPROPERTIES=${properties}" -DFOLDER=${CMAKE_CURRENT_BINARY_DIR} -DOUT=${entries}
      -P ${PROJECT_SOURCE_DIR}/cmake/DiscoverSuites.cmake
    VERBATIM)
  set(wrapper ${CMAKE_CURRENT_BINARY_DIR}/${name}_include.cmake)
  file(WRITE ${wrapper} "if(EXISTS [=[${entries}]=])\n  include([=[${entries}]=])\nelse()\n  add_test(${name}_NOT_BUILT ${name}_NOT_BUILT)\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${wrapper})
endfunction()

# volgi_test(NAME LABELS... SOURCES... LIBS... [FILTER googletest's] [SUITES]): one GoogleTest program; one ctest entry per
# test case, or with SUITES per suite.
function(volgi_test name)
  cmake_parse_arguments(T "SUITES" "TIMEOUT;FILTER" "LABELS;SOURCES;LIBS" ${ARGN})
  if(NOT T_TIMEOUT AND T_SUITES)
    set(T_TIMEOUT 900)
  elseif(NOT T_TIMEOUT)
    set(T_TIMEOUT 300)
  endif()
  add_executable(test_${name} ${T_SOURCES})
  target_link_libraries(test_${name} PRIVATE ${T_LIBS} test_paths GTest::gtest GTest::gtest_main)
  # No -fPIC or -fPIE of CMake's: the flags of the precompiled headers, a library's, would not be the same.
  set_target_properties(test_${name} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
  volgi_use_precompiled_later(test_${name} volgi_test_precompiled)
  if(NOT T_LABELS)
    set(T_LABELS cpu)
  endif()
  if(T_SUITES)
    volgi_discover_suites(test_${name} ${name}. "LABELS ${T_LABELS} TIMEOUT ${T_TIMEOUT}" FILTER "${T_FILTER}")
  else()
    gtest_discover_tests(test_${name} TEST_PREFIX "${name}." TEST_FILTER "${T_FILTER}" DISCOVERY_TIMEOUT 60
      PROPERTIES LABELS "${T_LABELS}" TIMEOUT ${T_TIMEOUT})
  endif()
endfunction()
