# A check of every pointer before every use costs a third of the compilation of
# Eigen's templates; a null or freed pointer and a read beyond an object stop the
# address sanitizer, a misaligned matrix stops Eigen's own assertion, and nothing
# here is cast from a base to a derived class.
set(HINDSIGHT_SANITIZE_WITHOUT
    -fno-sanitize=null,alignment,object-size,vptr)

function(hindsight_compile_options target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND
     (CMAKE_BUILD_TYPE STREQUAL "Release" OR HINDSIGHT_SANITIZE))
    # False alarms of GCC 12 at -O3, inside std::string (bug 105651) and Eigen,
    # and of its sanitizers, inside std::optional.
    target_compile_options(${target} PRIVATE -Wno-restrict
                           -Wno-maybe-uninitialized)
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Collecting garbage while it expands Eigen's templates costs GCC a quarter of
    # its time and saves a fifth of its 1.5 GB.
    target_compile_options(${target} PRIVATE --param=ggc-min-heapsize=3000000)
  endif()
  if(HINDSIGHT_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(HINDSIGHT_COVERAGE)
    target_compile_options(${target} PRIVATE --coverage -fprofile-update=atomic)
    target_link_options(${target} PRIVATE --coverage)
  endif()
  if(HINDSIGHT_SANITIZE)
    target_compile_options(${target} PRIVATE
      -fsanitize=${HINDSIGHT_SANITIZE} -fno-omit-frame-pointer
      -fno-sanitize-recover=all ${HINDSIGHT_SANITIZE_WITHOUT})
    # Eigen aligns memory in a way of its own under a sanitizer, but Ceres, which
    # was compiled without, frees what Eigen here has taken.
    target_compile_definitions(${target} PRIVATE EIGEN_MALLOC_ALREADY_ALIGNED=1)
    target_link_options(${target} PRIVATE -fsanitize=${HINDSIGHT_SANITIZE})
  endif()
  # What a fuzzer is to find its way through.
  if(HINDSIGHT_BUILD_FUZZERS AND ${target} MATCHES "_(io_read|io_config|fuzz)$")
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
endfunction()

# Compiles several sources as one: most of the time goes into the templates of
# Eigen, which all share. HINDSIGHT_UNITY=OFF compiles each alone, which suits
# work on a single file.
option(HINDSIGHT_UNITY "Compile several sources of a folder as one" ON)
function(hindsight_unity target batch)
  if(HINDSIGHT_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON
      UNITY_BUILD_BATCH_SIZE ${batch})
  endif()
endfunction()

# hindsight_library(name folder DEPENDS ...) builds one library from all the
# sources of a folder, header-only when it has none.
function(hindsight_library name folder)
  cmake_parse_arguments(ARG "" "" "DEPENDS" ${ARGN})
  set(dependencies)
  foreach(dependency ${ARG_DEPENDS})
    if(TARGET hindsight_${dependency})
      list(APPEND dependencies hindsight_${dependency})
    else()
      list(APPEND dependencies ${dependency})
    endif()
  endforeach()
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS
    ${CMAKE_SOURCE_DIR}/${folder}/*.cc)
  if(sources)
    add_library(hindsight_${name} STATIC ${sources})
    target_include_directories(hindsight_${name} PUBLIC
      ${CMAKE_SOURCE_DIR}/src ${CMAKE_SOURCE_DIR})
    target_link_libraries(hindsight_${name} PUBLIC ${dependencies})
    hindsight_compile_options(hindsight_${name})
    hindsight_unity(hindsight_${name} 16)
  else()
    add_library(hindsight_${name} INTERFACE)
    target_include_directories(hindsight_${name} INTERFACE
      ${CMAKE_SOURCE_DIR}/src ${CMAKE_SOURCE_DIR})
    target_link_libraries(hindsight_${name} INTERFACE ${dependencies})
  endif()
endfunction()
