vs.1.1                          ; light of sky and ground at the vertex
; c0: world, view and projection, c10: axis of the sky, c20: one half, c41: sky, c42: ground
m4x4 oPos, v0, c0
dp3 r0, v3, c10
mad r0, r0, c20, c20            ; the share of the sky
mov r1, c42
sub r2, c41, r1
mad oD0, r0, r2, r1
