# cmake -DBUILD=... -DEXAMPLES=... -DSCRATCH=... -DPROGRAM=... -P my_vehicle_test.cmake
# Does what examples/outside/README.md says: installs the build tree BUILD under SCRATCH, copies the folder and the program
# out of the repository, builds and runs them there. They must print what PROGRAM, built inside, prints, and draw and
# report the same but for the time of day.
file(REMOVE_RECURSE ${SCRATCH})
set(prefix ${SCRATCH}/installed)
set(outside ${SCRATCH}/my_vehicle)

# run(FOLDER COMMAND...): the output goes to `output`.
function(run folder)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${folder} RESULT_VARIABLE status OUTPUT_VARIABLE text
                  ERROR_VARIABLE messages)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}: ${status}\n${text}${messages}")
  endif()
  set(output "${text}" PARENT_SCOPE)
endfunction()

run(${BUILD} ${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
file(COPY ${EXAMPLES}/outside/ DESTINATION ${outside})
file(COPY ${EXAMPLES}/my_vehicle.cpp DESTINATION ${outside})
run(${outside} ${CMAKE_COMMAND} -B build -G Ninja -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_BUILD_TYPE=Release)
run(${outside} ${CMAKE_COMMAND} --build build)

# Nothing of the repository may be seen from there.
file(STRINGS ${outside}/build/build.ninja lines)
cmake_path(GET EXAMPLES PARENT_PATH repository)
foreach(line IN LISTS lines)
  string(REPLACE "${SCRATCH}" "" line "${line}")
  if(line MATCHES "-(I|isystem) *${repository}(/easydyn|/vehicles|/track|/soil|/track_on_soil)?( |$)")
    message(FATAL_ERROR "the project outside includes from the repository: ${line}")
  endif()
endforeach()

file(MAKE_DIRECTORY ${SCRATCH}/inside)
run(${SCRATCH}/inside ${PROGRAM})
set(inside_output "${output}")
run(${outside} ${outside}/build/my_vehicle)
if(NOT output STREQUAL inside_output)
  message(FATAL_ERROR "the program prints\n${output}outside, but\n${inside_output}inside the repository")
endif()
foreach(file IN ITEMS my_vehicle.svg my_vehicle.html)
  foreach(place IN ITEMS ${SCRATCH}/inside ${outside})
    file(READ ${place}/${file} page)
    string(REGEX REPLACE " on [0-9-]+ [0-9:]+ UTC" "" page "${page}")  # when it was written
    string(SHA256 hash "${page}")
    if(place STREQUAL "${SCRATCH}/inside")
      set(hash_inside ${hash})
    elseif(NOT hash STREQUAL hash_inside)
      message(FATAL_ERROR "${file} differs from what the program writes inside the repository")
    endif()
  endforeach()
endforeach()
