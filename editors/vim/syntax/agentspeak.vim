" Colours of agents.
if exists('b:current_syntax')
  finish
endif

syntax match agentspeakAction /\<[a-z]\w*/
syntax match agentspeakVariable /\<[A-Z]\w*/
syntax match agentspeakUnnamed /\<_\w*/
syntax match agentspeakNumber /\<\d\+\(\.\d\+\)\?\([eE][+-]\?\d\+\)\?\>/
syntax match agentspeakOperator /\\==\|==\|<=\|>=\|[-+*/<>=&|!?]/
syntax match agentspeakArrow /<-/
syntax match agentspeakBelief /\([-+]\)\@1<=[a-z]\w*/
syntax match agentspeakGoal /!\@1<=\s*[a-z]\w*/
syntax match agentspeakBelief /?\@1<=\s*[a-z]\w*/
syntax match agentspeakLabel /@\s*[a-z]\w*/
syntax match agentspeakInternal /\.\s*\(wait\|send\|broadcast\|my_name\)\>/
syntax match agentspeakAnnotation /\<\(req\|deadline\|source\|age\)\ze\s*(/
syntax keyword agentspeakBoolean true false
syntax keyword agentspeakWord not mod
syntax match agentspeakEscape contained /\\["\\nt]/
syntax region agentspeakString start=/"/ end=/"\|$/ contains=agentspeakEscape
syntax match agentspeakComment +//.*$+ contains=@Spell
syntax region agentspeakComment start=+/\*+ end=+\*/+ contains=@Spell

highlight default link agentspeakAction Function
highlight default link agentspeakVariable Identifier
highlight default link agentspeakUnnamed Special
highlight default link agentspeakNumber Number
highlight default link agentspeakOperator Operator
highlight default link agentspeakArrow Statement
highlight default link agentspeakBelief Type
highlight default link agentspeakGoal Structure
highlight default link agentspeakLabel Label
highlight default link agentspeakInternal Keyword
highlight default link agentspeakAnnotation PreProc
highlight default link agentspeakBoolean Boolean
highlight default link agentspeakWord Keyword
highlight default link agentspeakEscape SpecialChar
highlight default link agentspeakString String
highlight default link agentspeakComment Comment

let b:current_syntax = 'agentspeak'
