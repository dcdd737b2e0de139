# Takes ipos away again, by what its installer wrote into the list of programs.
$ErrorActionPreference = 'Stop'
foreach ($key in Get-UninstallRegistryKey -SoftwareName 'ipos') {
  $program = $key.UninstallString.Trim('"')
  Uninstall-ChocolateyPackage -PackageName 'ipos' -FileType 'exe' -SilentArgs '/S' -File $program
}
