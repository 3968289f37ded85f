# What every target of the house shares: language, warnings, sanitizers, where programs go, how a room becomes a library.
include(GNUInstallDirs)

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
find_program(VOLGI_CCACHE ccache)
if(VOLGI_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${VOLGI_CCACHE})
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
target_compile_definitions(volgi_options INTERFACE GLM_FORCE_DEPTH_ZERO_TO_ONE GLM_ENABLE_EXPERIMENTAL)

# volgi_room(NAME SOURCES... PUBLIC libs... PRIVATE libs...): static library volgi_NAME, alias volgi::NAME.
function(volgi_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(volgi_${name} STATIC ${ROOM_SOURCES})
  add_library(volgi::${name} ALIAS volgi_${name})
  set_target_properties(volgi_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(volgi_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/volgi>)
  target_link_libraries(volgi_${name} PUBLIC volgi_options ${ROOM_PUBLIC} PRIVATE ${ROOM_PRIVATE})
  set_property(GLOBAL APPEND PROPERTY VOLGI_TARGETS volgi_${name})
endfunction()

# volgi_test(NAME LABELS... SOURCES... LIBS... [FILTER googletest's]): one GoogleTest program, one ctest entry per test
# case.
function(volgi_test name)
  cmake_parse_arguments(T "" "TIMEOUT;FILTER" "LABELS;SOURCES;LIBS" ${ARGN})
  if(NOT T_TIMEOUT)
    set(T_TIMEOUT 300)
  endif()
  add_executable(test_${name} ${T_SOURCES})
  target_link_libraries(test_${name} PRIVATE ${T_LIBS} test_paths GTest::gtest GTest::gtest_main)
  if(NOT T_LABELS)
    set(T_LABELS cpu)
  endif()
  gtest_discover_tests(test_${name} TEST_PREFIX "${name}." TEST_FILTER "${T_FILTER}" DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS "${T_LABELS}" TIMEOUT ${T_TIMEOUT})
endfunction()
