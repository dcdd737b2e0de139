# Installs ipos for the user who calls it.
$ErrorActionPreference = 'Stop'
Install-ChocolateyPackage -PackageName 'ipos' -FileType 'exe' -SilentArgs '/S' `
  -Url64bit '@ADDRESS@/v@VERSION@/@SETUP@' -Checksum64 '@SHA256@' -ChecksumType64 'sha256'
