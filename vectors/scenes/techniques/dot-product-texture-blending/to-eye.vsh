vs.1.1                          ; the direction to the viewer, not of unit length
; c0: matrix, c4: viewer
m4x4 oPos, v0, c0
mov oT0.xyz, v7.xyz             ; what the normals are looked up with
add oT1.xyz, c4.xyz, -v0.xyz
