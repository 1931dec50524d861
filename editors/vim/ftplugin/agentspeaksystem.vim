" Comments and indentation of systems, which are those of agents.
runtime! ftplugin/agentspeak.vim
