# Installs stribeck {{version}} for this user from the archive beside this file. $env:STRIBECK_TO names the folder of the
# program, $env:STRIBECK_FROM where the archive is, a folder or an address.
$ErrorActionPreference = "Stop"

$from = if ($env:STRIBECK_FROM) { $env:STRIBECK_FROM } else { $PSScriptRoot }
$to = if ($env:STRIBECK_TO) { $env:STRIBECK_TO } else { "$env:LOCALAPPDATA\Programs\stribeck" }
$name = "stribeck-{{version}}-x86_64-pc-windows-gnu"
$sums = @"
{{sums}}
"@
$sum = $sums -split "`n" | Where-Object { $_.Trim().EndsWith("  $name.zip") } | ForEach-Object { $_.Split(" ")[0] }
if (-not $sum) { throw "This release has no program for Windows: cargo install --profile dist stribeck builds it." }
$work = Join-Path ([IO.Path]::GetTempPath()) ([IO.Path]::GetRandomFileName())
New-Item -ItemType Directory $work | Out-Null
try {
    $archive = Join-Path $work "$name.zip"
    if (Test-Path $from) { Copy-Item "$from\$name.zip" $archive } else { Invoke-WebRequest "$from/$name.zip" -OutFile $archive }
    if ((Get-FileHash $archive -Algorithm SHA256).Hash -ne $sum) { throw "$name.zip is damaged: its checksum differs." }
    Expand-Archive $archive $work
    New-Item -ItemType Directory -Force $to | Out-Null
    Move-Item -Force "$work\$name\stribeck.exe" "$to\stribeck.exe"
} finally {
    Remove-Item -Recurse -Force $work
}
$path = [Environment]::GetEnvironmentVariable("Path", "User")
if (($path -split ";") -notcontains $to) { [Environment]::SetEnvironmentVariable("Path", "$path;$to", "User") }
Write-Output "$to\stribeck.exe is there: stribeck demo, in a new window, shows what it does."
