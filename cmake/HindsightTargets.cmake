function(hindsight_compile_options target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_BUILD_TYPE STREQUAL "Release")
    # False alarms of GCC 12 at -O3, inside std::string (bug 105651) and Eigen.
    target_compile_options(${target} PRIVATE -Wno-restrict
                           -Wno-maybe-uninitialized)
  endif()
  if(HINDSIGHT_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(HINDSIGHT_SANITIZE)
    target_compile_options(${target} PRIVATE
      -fsanitize=${HINDSIGHT_SANITIZE} -fno-omit-frame-pointer
      -fno-sanitize-recover=all)
    target_link_options(${target} PRIVATE -fsanitize=${HINDSIGHT_SANITIZE})
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
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.cc)
  if(sources)
    add_library(hindsight_${name} STATIC ${sources})
    target_include_directories(hindsight_${name} PUBLIC
      ${CMAKE_SOURCE_DIR}/src ${CMAKE_SOURCE_DIR})
    target_link_libraries(hindsight_${name} PUBLIC ${dependencies})
    hindsight_compile_options(hindsight_${name})
  else()
    add_library(hindsight_${name} INTERFACE)
    target_include_directories(hindsight_${name} INTERFACE
      ${CMAKE_SOURCE_DIR}/src ${CMAKE_SOURCE_DIR})
    target_link_libraries(hindsight_${name} INTERFACE ${dependencies})
  endif()
endfunction()
