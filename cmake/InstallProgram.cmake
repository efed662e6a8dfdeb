# SPDX-License-Identifier: MIT
# Installs the program with the programs and modules that it starts and loads in one folder; bin/deburr is a link into
# that folder. Files that it reads (ready sweeps, testplans and the pages they name) keep their repository paths below
# share/deburr (tb/base/ready_file.h).
set(DEBURR_PROGRAM_FOLDER "${CMAKE_INSTALL_LIBEXECDIR}/deburr")
set(DEBURR_DATA_FOLDER "${CMAKE_INSTALL_DATADIR}/deburr")
add_dependencies(deburr_installed deburr_complete)
if(TARGET deburr_python)
  add_dependencies(deburr_installed deburr_python)
  if(TARGET deburr_python_stubs)
    add_dependencies(deburr_installed deburr_python_stubs)
  endif()
endif()

# The link path is that of a SystemC in a prefix of its own.
set_target_properties(deburr deburr_papers deburr_train PROPERTIES INSTALL_RPATH "$ORIGIN" INSTALL_RPATH_USE_LINK_PATH ON)
install(TARGETS deburr deburr_papers deburr_train RUNTIME DESTINATION "${DEBURR_PROGRAM_FOLDER}" COMPONENT program)
foreach(module deburr_images deburr_evolution)
  if(TARGET ${module})
    install(TARGETS ${module} LIBRARY DESTINATION "${DEBURR_PROGRAM_FOLDER}" COMPONENT program)
  endif()
endforeach()
file(RELATIVE_PATH path "/${CMAKE_INSTALL_BINDIR}" "/${DEBURR_PROGRAM_FOLDER}/deburr")
set(link "${PROJECT_BINARY_DIR}/installed/deburr")
file(CREATE_LINK "${path}" "${link}" SYMBOLIC)
install(FILES "${link}" DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT program)

# deburr_printed(<file> <folder> <word>...): output of the program itself; not installed if no folder is given.
set(printed "")
function(deburr_printed file folder)
  set(output "${PROJECT_BINARY_DIR}/installed/${file}")
  add_custom_command(OUTPUT "${output}" COMMAND deburr ${ARGN} > "${output}" DEPENDS deburr VERBATIM)
  if(folder)
    install(FILES "${output}" DESTINATION "${folder}" COMPONENT program)
  endif()
  set(printed ${printed} "${output}" PARENT_SCOPE)
endfunction()
file(MAKE_DIRECTORY "${PROJECT_BINARY_DIR}/installed/bash")
deburr_printed(bash/deburr "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" completion bash)
deburr_printed(_deburr "${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions" completion zsh)
deburr_printed(deburr.fish "${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d" completion fish)
deburr_printed(deburr.1 "" help --man)  # Package.cmake compresses it
add_custom_target(deburr_printed ALL DEPENDS ${printed})
add_dependencies(deburr_installed deburr_printed)

install(DIRECTORY "${PROJECT_SOURCE_DIR}/sweeps" "${PROJECT_SOURCE_DIR}/docs" DESTINATION "${DEBURR_DATA_FOLDER}"
  COMPONENT program)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/tb/testplan" DESTINATION "${DEBURR_DATA_FOLDER}/tb" COMPONENT program)
# Testplans include those of the engines.
foreach(engine ${DEBURR_ENGINES})
  file(GLOB plans CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/tb/engines/${engine}/*.yaml")
  install(FILES ${plans} DESTINATION "${DEBURR_DATA_FOLDER}/tb/engines/${engine}" COMPONENT program)
endforeach()
